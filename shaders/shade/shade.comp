#version 460
#extension GL_GOOGLE_include_directive : require
// Scenes without rectangular and disc lights.
#include "shade/deferred.glsl"
