// Levels for six directions (Crassin et al. 2011, Section 6): walls stay opaque and have two sides. Costs
// three lookups per sample.
#ifndef MIPS_GLSL
#define MIPS_GLSL
#include "voxels/directions.glsl"

vec3 directionWeights(vec3 dir);

// Length that an opacity refers to [m]: a cell of the level, over which the directions are composited.
float opacityLength(float voxel, float cell) {
    return cell;
}

// Radiance and opacity of the voxels around u, seen along dir (unit length, in cells).
vec4 sampleLevel(vec3 u, vec3 dir, float level) {
    // Querying the texture's size in the loop costs 0.01 ms at 1080p.
    return sampleDirections(voxelRadiance, u, dir, directionWeights(dir), max(level, 0.0),
        float(params.voxel_dim));
}

#endif
