#version 460
#extension GL_GOOGLE_include_directive : require
// In a scene where nothing emits.
#define SCENE_EMITS false
#include "gather/queued.glsl"
