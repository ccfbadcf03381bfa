#version 460
#extension GL_GOOGLE_include_directive : require
// Sets up the triangles that the camera may see, for their numbers.
#include "gbuffer/triangles32.glsl"
#include "raster/setup.glsl"
