#version 460
#extension GL_GOOGLE_include_directive : require
// Places a volume that does not move.
#include "params.glsl"
#include "volume/place.glsl"
