#version 460
#extension GL_GOOGLE_include_directive : require
// A volume parts of which follow the camera, or that keeps cells.
#include "params.glsl"
#define VOLUME_FOLLOWS
#include "volume/place.glsl"
