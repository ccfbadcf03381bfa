#version 460
#extension GL_GOOGLE_include_directive : require
// Fills tiles of them that the camera may see, for their numbers.
#include "gbuffer/triangles32.glsl"
#include "raster/tiles.glsl"
