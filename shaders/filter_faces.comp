#version 460
#extension GL_GOOGLE_include_directive : require
// A level of the faces from the finer one.
#include "filter_faces.glsl"
