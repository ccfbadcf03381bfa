// Slots that stay while the volume scrolls.
#ifndef VOXEL_KEPT_GLSL
#define VOXEL_KEPT_GLSL

layout(std430) buffer VoxelKept { uint words[]; } voxelKept;
layout(std430) buffer KeptCounter {
    uint count;
    uvec3 groups; // indirect dispatch over them
} keptCounter;

#endif
