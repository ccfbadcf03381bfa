// Surfels that stay while the volume scrolls.
#ifndef VOXEL_KEPT_GLSL
#define VOXEL_KEPT_GLSL

#include "surfels/surfels.glsl"

// Of each the words of its surfel, and those of its planes that are merged.
const uint SCROLLED_MASKS = SURFEL_SUM_WORDS;
const uint SCROLLED_WORDS = SURFEL_SUM_WORDS + SURFEL_WORDS - SURFEL_MASKS;

layout(std430) buffer ScrolledSurfels { uint words[]; } scrolledSurfels;
layout(std430) buffer ScrolledCounter {
    uint count;
    uvec3 groups; // indirect dispatch over them, 128 a group
} scrolledCounter;

#endif
