#version 460
#extension GL_GOOGLE_include_directive : require
// Gathers without emitter samples, for scenes without emitters.
#define SCENE_EMITS false
#include "bounce/queued.glsl"
