#version 460
#extension GL_GOOGLE_include_directive : require
// Where no map is around the camera, which may move then and no map changes.
#include "shadow/place.glsl"
