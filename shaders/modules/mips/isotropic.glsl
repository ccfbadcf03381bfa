// Filtered levels that shine and hide alike in all directions: one lookup a sample.
#ifndef MIPS_GLSL
#define MIPS_GLSL

// What one opacity is told for [m]: a voxel, because means thin surfaces out as cells grow.
float opacityLength(float voxel, float cell) {
    return voxel;
}

vec4 sampleLevel(vec3 u, vec3 dir, float level) {
    return textureLod(voxelRadiance, u, level);
}

#endif
