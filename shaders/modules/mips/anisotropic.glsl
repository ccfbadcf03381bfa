// Levels for six directions (Crassin et al. 2011, Section 6): walls hide what is behind them, and have two sides. Three
// lookups a sample.
#ifndef MIPS_GLSL
#define MIPS_GLSL
#include "voxels/directions.glsl"

vec3 directionWeights(vec3 dir);

// What one opacity is told for [m]: a cell of the level, which the directions are composited over.
float opacityLength(float voxel, float cell) {
    return cell;
}

// The voxels around u as a cone along dir (unit length, in cells) finds them.
vec4 sampleLevel(vec3 u, vec3 dir, float level) {
    // Asking the texture for its size in the loop costs 0.01 ms at 1080p.
    return sampleDirections(voxelRadiance, u, dir, directionWeights(dir), max(level, 0.0), float(params.voxel_dim));
}

#endif
