#version 460
#extension GL_GOOGLE_include_directive : require
// Gathers with emitter samples, for scenes with emitters: SCENE_EMITS stays true (gather/emitters.glsl).
#include "bounce/queued.glsl"
