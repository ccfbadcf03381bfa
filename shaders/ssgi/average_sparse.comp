#version 460
#extension GL_GOOGLE_include_directive : require
// Every other pixel of 8x8.
#include "ssgi/average.glsl"

void main() {
    averageOver(4, 2);
}
