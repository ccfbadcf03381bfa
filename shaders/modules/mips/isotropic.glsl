// Filtered levels that are the same in all directions. Costs one lookup per sample.
#ifndef MIPS_GLSL
#define MIPS_GLSL

// Length that an opacity refers to [m]: a voxel, because averaging thins out surfaces as cells grow.
float opacityLength(float voxel, float cell) {
    return voxel;
}

vec4 sampleLevel(vec3 u, vec3 dir, float level) {
    return textureLod(voxelRadiance, u, level);
}

#endif
