#version 460
#extension GL_GOOGLE_include_directive : require
// Scenes with emitters.
#include "gather/queued.glsl"
