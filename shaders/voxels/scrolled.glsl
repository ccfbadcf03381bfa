// Surfels that are reused while the volume scrolls.
#ifndef VOXEL_KEPT_GLSL
#define VOXEL_KEPT_GLSL

#include "surfels/surfels.glsl"

// Per surfel: its sums and cell, then the words of masks and front layers.
const uint SCROLLED_MASKS = SURFEL_SUM_WORDS;
const uint SCROLLED_WORDS = SURFEL_SUM_WORDS + SURFEL_WORDS - SURFEL_MASKS;

layout(std430) buffer ScrolledSurfels { uint words[]; } scrolledSurfels;
layout(std430) buffer ScrolledCounter {
    uint count;
    uvec3 groups; // indirect dispatch over the surfels, 128 per group
} scrolledCounter;

#endif
