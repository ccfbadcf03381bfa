// Shadow maps as words: float depths, with bits that compare like integers. The least depth wins.
#include "params.glsl"
#include "shadow/layers.glsl"

layout(r32ui) uniform uimage2DArray shadowWords;

ivec2 targetSize() {
    return ivec2(params.shadow_dim);
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

bool isNearer(ivec2 pixel, uint layer, float depth) {
    return floatBitsToUint(depth) < imageLoad(shadowWords, ivec3(pixel, layer)).r;
}

void plot(ivec2 pixel, uint layer, float depth, uint triangle) {
    imageAtomicMin(shadowWords, ivec3(pixel, layer), floatBitsToUint(depth));
}
