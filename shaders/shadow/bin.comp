#version 460
#extension GL_GOOGLE_include_directive : require
// Bins the large triangles in the lights' views, for all layers at once.
#include "shadow/target.glsl"
#include "raster/bin.glsl"
