#version 460
#extension GL_GOOGLE_include_directive : require
// With nested maps: layers of directional lights move with the camera.
#define NESTED_MAPS
#include "shadow/place.glsl"
