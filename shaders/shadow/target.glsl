// Shadow maps as words: float depths, with bits that compare like integers. The least depth wins.
#include "params.glsl"
#include "shadow/layers.glsl"

layout(r32ui) uniform uimage2DArray shadowWords;

// Views that a thread sets up, of one or several lights; as passes/parts/shadow_compute.ron dispatches.
const uint LAYERS = 8;

uint targetLayers() {
    return uint(params.shadow_layers);
}

// x: corner of the layer's square in the texture; y: its page and edge.
uvec2 targetOf(uint layer) {
    ShadowLayer l = shadowLayers.layers[layer];
    return uvec2(l.corner, l.page << 16 | l.edge);
}

ivec2 targetSize(uvec2 target) {
    return ivec2(target.y & 0xffffu);
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

ivec3 texelOf(ivec2 pixel, uvec2 target) {
    return ivec3(pixel + ivec2(target.x & 0xffffu, target.x >> 16), target.y >> 16);
}

bool isNearer(ivec2 pixel, uvec2 target, float depth) {
    return floatBitsToUint(depth) < imageLoad(shadowWords, texelOf(pixel, target)).r;
}

void plot(ivec2 pixel, uvec2 target, float depth, uint triangle) {
    imageAtomicMin(shadowWords, texelOf(pixel, target), floatBitsToUint(depth));
}
