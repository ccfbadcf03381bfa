#version 460
#extension GL_GOOGLE_include_directive : require
// Alpha mask of shadow maps.
#define MASK_FOOTPRINT 1.0
#include "materials/masked.glsl"
