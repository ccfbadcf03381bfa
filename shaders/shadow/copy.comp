#version 460
#extension GL_GOOGLE_include_directive : require
// Begins the maps with what never moves.
#include "shadow/texels.glsl"

layout(r32ui) uniform readonly uimage2DArray stillWords;
layout(r32ui) uniform writeonly uimage2DArray shadowWords;

void main() {
    uvec4 words[TEXELS];
    for (int i = 0; i < TEXELS; i++) words[i] = imageLoad(stillWords, texelOfThread(i));
    for (int i = 0; i < TEXELS; i++) imageStore(shadowWords, texelOfThread(i), words[i]);
}
