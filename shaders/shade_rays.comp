#version 460
#extension GL_GOOGLE_include_directive : require
// Final shading by rays through the voxels, in place of cones. A shader of its own: its code would slow every change
// of the other down.
#define VOXEL_RAYS
#include "shade_pixels.glsl"
