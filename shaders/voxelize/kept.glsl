// Slots that stay while the volume scrolls.
#ifndef VOXEL_KEPT_GLSL
#define VOXEL_KEPT_GLSL

#include "common/planes.glsl"

// Of each the words of its slot, and those of its planes that are merged.
const uint KEPT_PARTS = SLOT_WORDS;
const uint KEPT_WORDS = SLOT_WORDS + PLANE_WORDS - PLANE_PARTS;

layout(std430) buffer VoxelKept { uint words[]; } voxelKept;
layout(std430) buffer KeptCounter {
    uint count;
    uvec3 groups; // indirect dispatch over them, 128 a group
} keptCounter;

#endif
