// Start of cones, and lookups that stay inside their cascade.
#ifndef CASCADE_LOOKUP_GLSL
#define CASCADE_LOOKUP_GLSL
#include "cones/origin.glsl"
#include "modules/mips.glsl"

// Width of the blend into the next cascade at a border [cells of the level].
const float BLEND_CELLS = 6.0;

float cascadeWeight(vec3 u, float level) {
    vec3 inside = mix(vec3(1.0), min(u, 1.0 - u), CURVED_BORDERS);
    return clamp(min(inside.x, min(inside.y, inside.z)) * float(params.voxel_dim)
        / (BLEND_CELLS * exp2(max(level, 0.0))), 0.0, 1.0);
}

// Starts outside the voxels of the cone's own surface, `bias` cell extents off it.
ConeOrigin coneOrigin(vec3 p, vec3 geometric, vec3 shading) {
    int cascade = cascadeAt(p);
    VolumeMap map = volume.maps[cascade];
    float reach = cellReach(map, p, geometric), weight = 1.0;
    if (CASCADE_COUNT > 1 && cascade < CASCADE_COUNT - 1) {
        weight = cascadeWeight(worldToVolume(map, p), 0.0);
        reach = mix(cellReach(volume.maps[cascade + 1], p, geometric), reach, weight);
    }
    float height = 2.0 * params.bias * reach;
    return ConeOrigin(p + height * geometric, geometric, height, reach, cascade,
        p + 2.0 * params.ray_bias * reach * geometric, weight);
}

// Keeps a lookup half a cell of its level away from the seams between stored cascades.
vec4 sampleCascade(vec3 u, int cascade, vec3 dir, float level) {
    if (CASCADE_COUNT > 1) {
        float margin = 0.5 * exp2(ceil(max(level, 0.0))) / float(params.voxel_dim);
        u.z = (float(cascade) + clamp(u.z, margin, 1.0 - margin)) / float(CASCADE_COUNT);
    }
    return sampleLevel(u, dir, level);
}

// The same. At the seam of spheres, where the first cells follow the last, it blends both sides.
vec4 sampleMap(vec3 u, int cascade, vec3 dir, float level) {
    if (!CURVED_SEAM || cascade > 0) return sampleCascade(u, cascade, dir, level);
    float half_cell = 0.5 * exp2(level) / float(params.voxel_dim);
    vec4 texel = sampleCascade(vec3(clamp(u.x, half_cell, 1.0 - half_cell), u.yz), cascade, dir, level);
    float over = max(half_cell - u.x, u.x - 1.0 + half_cell) / (2.0 * half_cell);
    if (over <= 0.0) return texel;
    return mix(texel,
        sampleCascade(vec3(u.x < 0.5 ? 1.0 - half_cell : half_cell, u.yz), cascade, dir, level), over);
}

#endif
