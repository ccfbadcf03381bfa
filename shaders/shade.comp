#version 460
#extension GL_GOOGLE_include_directive : require
// Final shading by cones, a thread a pixel.
#include "shade_pixels.glsl"
