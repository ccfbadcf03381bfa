// Filtered levels for six directions (Crassin et al. 2011, Section 6): walls hide what is behind them and shine little to
// their back. Three lookups a sample.
#ifndef MIPS_GLSL
#define MIPS_GLSL
#include "common/directions.glsl"

uniform sampler3D voxelRadianceAniso; // levels 1 and up

vec3 directionWeights(vec3 dir);

// What one opacity is told for [m]: a cell of the level, which the directions are composited over.
float opacityLength(float voxel, float cell) {
    return cell;
}

// The voxels around u as a cone along dir (unit length, in cells) finds them.
vec4 sampleLevel(vec3 u, vec3 dir, float level) {
    vec3 w = directionWeights(dir);
    float cells = float(params.half_dim); // asking the texture in the loop costs 0.01 ms at 1080p
    if (level >= 1.0) return sampleDirections(voxelRadianceAniso, u, dir, w, level - 1.0, cells);
    vec4 fine = textureLod(voxelRadiance, u, 0.0);
    return level <= 0.0 ? fine : mix(fine, sampleDirections(voxelRadianceAniso, u, dir, w, 0.0, cells), level);
}

#endif
