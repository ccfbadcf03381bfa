#version 460
#extension GL_GOOGLE_include_directive : require
// Scenes with rectangular or disc lights.
#define AREA_LIGHTS
#include "shade/deferred.glsl"
