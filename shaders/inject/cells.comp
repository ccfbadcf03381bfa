#version 460
#extension GL_GOOGLE_include_directive : require
// What leaves a cell by direction, all its sides together, premultiplied by opacity: for filtered levels, and who looks at voxels.
#include "params.glsl"
#include "common/volume.glsl"
#include "common/directions.glsl"
#include "common/sides.glsl"
#include "common/surfels.glsl"
#include "common/bricks.glsl"

layout(local_size_x = 128) in;

uniform writeonly image3D injected;

// Opacity of a surface to rays along d, which cross fewer of its cells the straighter they meet it; none goes through along the
// axis that it faces.
float opacityTo(Side s, vec3 d) {
    vec3 a = abs(s.normal);
    float steepest = max(a.x, max(a.y, a.z));
    return steepest > 0.0 ? mix(1.0, abs(dot(s.normal, d)) / steepest, s.agreement) : 1.0;
}

void main() {
    uint surfel = gl_GlobalInvocationID.x;
    if (surfel >= voxelCounter.count || axisOfSurfel(surfel) < 0) return;
    ivec3 cell = cellOfSurfel(surfel);
    uint found = foundAtStored(cell);
    if (surfel != firstSurfel(found)) return;

    VolumeMap map = volume.maps[cascadeOf(cell)];
    vec3 center = volumeToWorld(map, cellCentre(cell));
    mat3 axes = cellAxes(map, center);
    vec3 light[6] = vec3[6](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    float seen[6] = float[6](0.0, 0.0, 0.0, 0.0, 0.0, 0.0), opacity[6] = seen;
    for (uint i = 0; i < surfelCount(found) * SIDES; i++) {
        uint side = i % SIDES;
        Side s = sideOfSurfel(surfel + i / SIDES, side);
        vec3 radiance = lightOf(sideRadiance.list[sideNumber(surfel, i)]);
        for (int face = 0; face < 6; face++) {
            vec3 d = normalize(axes * mipDirection(face));
            float area = s.count * meanCosine(s, -d);
            light[face] += area * radiance;
            seen[face] += area;
            if (area > 0.0) opacity[face] = min(opacity[face] + opacityTo(s, d), 1.0);
        }
    }
    if (params.radiance_faces == 1) {
        vec3 sum = vec3(0.0);
        float all = 0.0;
        for (int face = 0; face < 6; face++) {
            sum += light[face];
            all += seen[face];
        }
        imageStore(injected, cell, vec4(sum / max(all, 1e-6), all > 0.0 ? 1.0 : 0.0)); // 0: all was cut out
        return;
    }
    for (int face = 0; face < 6; face++)
        imageStore(injected, ivec3(cell.x + face * params.voxel_dim, cell.yz), vec4(light[face] / max(seen[face], 1e-6) * opacity[face], opacity[face]));
}
