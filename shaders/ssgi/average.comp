#version 460
#extension GL_GOOGLE_include_directive : require
// 2x2 means of every other pixel: together each pixel of 8x8 once.
#include "ssgi/average.glsl"

void main() {
    averageOver(2, 1);
}
