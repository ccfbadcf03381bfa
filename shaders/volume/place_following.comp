#version 460
#extension GL_GOOGLE_include_directive : require
// Places a volume that follows the camera, at least in part, or reuses cells of the last frame.
#include "params.glsl"
#define VOLUME_FOLLOWS
#include "volume/place.glsl"
