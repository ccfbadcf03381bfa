// Surfels that stay while the volume scrolls.
#ifndef VOXEL_KEPT_GLSL
#define VOXEL_KEPT_GLSL

#include "surfels/surfels.glsl"

// Of each the words of its surfel, and those of its planes that are merged.
const uint KEPT_MASKS = SURFEL_SUM_WORDS;
const uint KEPT_WORDS = SURFEL_SUM_WORDS + SURFEL_WORDS - SURFEL_MASKS;

layout(std430) buffer VoxelKept { uint words[]; } voxelKept;
layout(std430) buffer KeptCounter {
    uint count;
    uvec3 groups; // indirect dispatch over them, 128 a group
} keptCounter;

#endif
