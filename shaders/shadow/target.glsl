// Shadow maps as words: float depths, with bits that compare like integers. The least depth wins.
#include "params.glsl"
#include "shadow/layers.glsl"

layout(r32ui) uniform uimage2DArray shadowWords;

ivec2 targetSize(uint layer) {
    return ivec2(shadowLayers.layers[layer].edge);
}

vec4 targetClip(vec3 p, uint layer) {
    return shadowLayers.layers[layer].view_projection * vec4(p, 1.0);
}

float targetNear(uint layer) {
    return shadowLayers.layers[layer].near;
}

float targetFootprint() {
    return 1.0;
}

ivec3 texelOf(ivec2 pixel, uint layer) {
    return ivec3(pixel + shadowCorner(layer), shadowLayers.layers[layer].page);
}

bool isNearer(ivec2 pixel, uint layer, float depth) {
    return floatBitsToUint(depth) < imageLoad(shadowWords, texelOf(pixel, layer)).r;
}

void plot(ivec2 pixel, uint layer, float depth, uint triangle) {
    imageAtomicMin(shadowWords, texelOf(pixel, layer), floatBitsToUint(depth));
}
