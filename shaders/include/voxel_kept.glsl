// Slots that stay while the volume scrolls.
#ifndef VOXEL_KEPT_GLSL
#define VOXEL_KEPT_GLSL

layout(std430) KEPT_ACCESS buffer VoxelKept { uint words[]; } voxelKept;

#endif
