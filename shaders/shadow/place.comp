#version 460
#extension GL_GOOGLE_include_directive : require
// Without nested maps: no layer depends on the camera.
#include "shadow/place.glsl"
