#version 460
#extension GL_GOOGLE_include_directive : require
// Fills tiles of them that lights see, for all layers at once.
#include "shadow/target.glsl"
#include "raster/tiles.glsl"
