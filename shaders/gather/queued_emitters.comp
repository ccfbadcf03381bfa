#version 460
#extension GL_GOOGLE_include_directive : require
// In a scene with emitters.
#include "gather/queued.glsl"
