// Depth and triangle in one word: one 64-bit maximum decides.
#include "gbuffer/visibility.glsl"

layout(std430) buffer Visibility { uint64_t words[]; } visibility;

bool isNearer(ivec2 pixel, uint layer, float depth) {
    return uint(visibility.words[wordOf(pixel)] >> 32) <= floatBitsToUint(depth);
}

void plot(ivec2 pixel, uint layer, float depth, uint triangle) {
    atomicMax(visibility.words[wordOf(pixel)], uint64_t(floatBitsToUint(depth)) << 32 | uint64_t(triangle));
}
