// Slots that stay while the volume scrolls.
#ifndef VOXEL_KEPT_GLSL
#define VOXEL_KEPT_GLSL

layout(std430) buffer VoxelKept { uint words[]; } voxelKept;

#endif
