#version 460
#extension GL_GOOGLE_include_directive : require
// Radiance of each cell in six directions: the mean over its sides, weighted by projected area and
// premultiplied by opacity. Input of filtered levels and of the voxel view.
#include "params.glsl"
#include "volume/volume.glsl"
#include "voxels/directions.glsl"
#include "surfels/sides.glsl"
#include "surfels/surfels.glsl"
#include "voxels/bricks.glsl"
#include "lights/emitters.glsl"

layout(local_size_x = 128) in;

uniform writeonly image3D injected;

// Fraction of the cell's face that a surfel covers, projected along its axis.
float coverageOf(uint surfel, uint side) {
    uint base = surfelBase(surfel);
    uvec2 mask = coverageMaskOf(base, side);
    if (mask == uvec2(0)) mask = coverageMaskOf(base, SIDES - 1 - side); // a mirrored side may lack a mask
    return float(coveredTexels(mask)) / 64.0;
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
        uvec2 packed = sideRadiance.list[sideIndex(surfel, i)];
        vec3 radiance = lightOf(packed);
        if (!WARPED && params.levels_emit == 0 && emitters.count > 0) radiance *= 1.0 - numberOf(packed);
        // Opacity is the projected area: coverage along the axis, times the ratio of the mean cosines towards
        // the direction and the axis.
        vec3 facing = normalize(axes * axisVector(uint(axisOfSurfel(surfel + i / SIDES))))
            * (side == 0 ? 1.0 : -1.0);
        float covered = coverageOf(surfel + i / SIDES, side), steepest = max(meanCosine(s, facing), 1e-3);
        for (int face = 0; face < 6; face++) {
            vec3 d = normalize(axes * mipDirection(face));
            float area = s.count * meanCosine(s, -d);
            light[face] += area * radiance;
            seen[face] += area;
            if (area > 0.0)
                opacity[face] = min(opacity[face] + covered * min(meanCosine(s, -d) / steepest, 1.0), 1.0);
        }
    }
    if (params.radiance_faces == 1) {
        vec3 sum = vec3(0.0);
        float all = 0.0;
        for (int face = 0; face < 6; face++) {
            sum += light[face];
            all += seen[face];
        }
        imageStore(injected, cell,
            vec4(sum / max(all, 1e-6), all > 0.0 ? 1.0 : 0.0)); // 0: all surfaces were cut out
        return;
    }
    for (int face = 0; face < 6; face++)
        imageStore(injected, ivec3(cell.x + face * params.voxel_dim, cell.yz),
            vec4(light[face] / max(seen[face], 1e-6) * opacity[face], opacity[face]));
}
