// Then the triangles that have them.
#include "gbuffer/visibility.glsl"

layout(std430) buffer Visibility { uvec2 words[]; } visibility; // triangle, depth

bool isNearer(ivec2 pixel, uint layer, float depth) {
    return visibility.words[wordOf(pixel)].y == floatBitsToUint(depth);
}

void plot(ivec2 pixel, uint layer, float depth, uint triangle) {
    if (isNearer(pixel, layer, depth)) atomicMax(visibility.words[wordOf(pixel)].x, triangle);
}
