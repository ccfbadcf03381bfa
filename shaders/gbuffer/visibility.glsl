// Visibility buffer (Burns and Hunt 2013): depth and triangle index of a pixel share one word, so one 64-bit
// atomic maximum resolves visibility. The including file enables the 64-bit extensions.
#ifndef VISIBILITY_GLSL
#define VISIBILITY_GLSL
#include "common/pixel.glsl"

const uint LAYERS = 1;

uint targetLayers() {
    return 1;
}

uvec2 targetOf(uint layer) {
    return uvec2(0);
}

ivec2 targetSize(uvec2 target) {
    return ivec2(camera.size);
}

vec4 targetClip(vec3 p, uint layer) {
    return sampledClip(camera.view_projection * vec4(p, 1.0));
}

float targetNear(uint layer) {
    return camera.near;
}

float targetFootprint() {
    return PIXEL_FOOTPRINT;
}

uint wordOf(ivec2 pixel) {
    return uint(pixel.y) * camera.size.x + uint(pixel.x);
}

layout(std430) buffer Visibility { uint64_t words[]; } visibility;

bool isNearer(ivec2 pixel, uvec2 target, float depth) {
    return uint(visibility.words[wordOf(pixel)] >> 32) <= floatBitsToUint(depth);
}

void plot(ivec2 pixel, uvec2 target, float depth, uint triangle) {
    atomicMax(visibility.words[wordOf(pixel)], uint64_t(floatBitsToUint(depth)) << 32 | uint64_t(triangle));
}

#endif
