#version 460
#extension GL_GOOGLE_include_directive : require
// Bins the large ones that lights see, for all layers at once.
#include "shadow/target.glsl"
#include "raster/bin.glsl"
