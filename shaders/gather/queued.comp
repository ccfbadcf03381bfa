#version 460
#extension GL_GOOGLE_include_directive : require
// Scenes without emitters.
#define SCENE_EMITS false
#include "gather/queued.glsl"
