// The level that a cone reads.
#ifndef CONE_LEVEL_GLSL
#define CONE_LEVEL_GLSL
#include "params.glsl"

// The level with cells 2^lod_offset times as wide as the cone. Callers clamp it.
float coneLevel(float voxel, float radius) {
    return log2(max(2.0 * radius / voxel, 1.0)) + params.lod_offset;
}

#endif
