#version 460
#extension GL_GOOGLE_include_directive : require
// A volume that stands still.
#include "params.glsl"
#include "volume/place.glsl"
