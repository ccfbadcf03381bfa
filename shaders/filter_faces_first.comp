#version 460
#extension GL_GOOGLE_include_directive : require
// The first level of the faces, from the voxels themselves.
#define FIRST_LEVEL
#include "filter_faces.glsl"
