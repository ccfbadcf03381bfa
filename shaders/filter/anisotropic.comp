#version 460
#extension GL_GOOGLE_include_directive : require
// A level by directions from the finer one.
#include "filter/anisotropic.glsl"
