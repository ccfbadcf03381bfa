// The blend between cascades, and origins that take part in it.
#ifndef CASCADE_WEIGHT_GLSL
#define CASCADE_WEIGHT_GLSL
#include "cones/origin.glsl"

// Width of the blend into the next cascade at a border [cells of the level].
const float BLEND_CELLS = 6.0;

float cascadeWeight(vec3 u, float level) {
    vec3 inside = mix(vec3(1.0), min(u, 1.0 - u), CURVED_BORDERS);
    return clamp(min(inside.x, min(inside.y, inside.z)) * float(params.voxel_dim)
        / (BLEND_CELLS * exp2(max(level, 0.0))), 0.0, 1.0);
}

// An origin `bias` cell extents off the surface for cones, and `ray_bias` for rays.
ConeOrigin originAbove(vec3 p, vec3 geometric, float bias, float ray_bias) {
    int cascade = cascadeAt(p);
    VolumeMap map = volume.maps[cascade];
    float reach = cellReach(map, p, geometric), weight = 1.0;
    if (CASCADE_COUNT > 1 && cascade < CASCADE_COUNT - 1) {
        weight = cascadeWeight(worldToVolume(map, p), 0.0);
        reach = mix(cellReach(volume.maps[cascade + 1], p, geometric), reach, weight);
    }
    float height = 2.0 * bias * reach;
    return ConeOrigin(p + height * geometric, geometric, height, reach, cascade,
        p + 2.0 * ray_bias * reach * geometric, weight);
}

#endif
