#version 460
#extension GL_GOOGLE_include_directive : require
// Clears to the farthest depth. A compute pass, because an image clear takes as long as drawing the map on a
// chip with few rasterisers.
#include "shadow/texels.glsl"

layout(r32ui) uniform writeonly uimage2DArray shadowWords;

void main() {
    for (int i = 0; i < TEXELS; i++) imageStore(shadowWords, texelOfThread(i), uvec4(floatBitsToUint(1.0)));
}
