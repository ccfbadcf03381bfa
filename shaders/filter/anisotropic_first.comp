#version 460
#extension GL_GOOGLE_include_directive : require
// The first level by directions, from the voxels themselves.
#define FIRST_LEVEL
#include "filter/anisotropic.glsl"
