#version 460
#extension GL_GOOGLE_include_directive : require
// Final shading by cones.
#include "forward.glsl"
