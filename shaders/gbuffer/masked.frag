#version 460
#extension GL_GOOGLE_include_directive : require
// Alpha mask of the depth prepass.
#include "modules/pixel.glsl"
#define MASK_FOOTPRINT PIXEL_FOOTPRINT
#include "materials/masked.glsl"
