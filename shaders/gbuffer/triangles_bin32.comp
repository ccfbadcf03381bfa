#version 460
#extension GL_GOOGLE_include_directive : require
// Bins the large ones that the camera may see, for their numbers.
#include "gbuffer/triangles32.glsl"
#include "raster/bin.glsl"
