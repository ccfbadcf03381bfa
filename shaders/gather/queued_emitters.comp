#version 460
#extension GL_GOOGLE_include_directive : require
// Scenes with emitters: SCENE_EMITS stays true (gather/emitters.glsl).
#include "gather/queued.glsl"
