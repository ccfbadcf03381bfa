#version 460
#extension GL_GOOGLE_include_directive : require
#define NESTED_MAPS
#include "shadow/place.glsl"
