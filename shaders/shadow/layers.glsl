// Layers of the shadow map: the lights' views, then finer ones of directional lights.
#ifndef SHADOW_LAYERS_GLSL
#define SHADOW_LAYERS_GLSL
#include "lights/lights.glsl"

struct ShadowLayer {
    mat4 view_projection;
    float width; // of the map in the world [m], at unit distance if perspective
    float perspective; // 1 or 0
    int finer; // layer that shows a part of this one; -1: none
    float rounding; // of depth, in addition to that of its format
    float near; // least w that is drawn
    uint edge; // of its square in the texture [texels]
    uint page; // layer of the texture
    uint corner; // of the square [texels]: x | y << 16
};

// Read-only, except in the pass that places them.
#ifndef LAYER_WRITES
readonly
#endif
layout(std430) buffer ShadowLayers { ShadowLayer layers[]; } shadowLayers;

// Face of a point light's shadow cube that contains direction d.
int cubeFace(vec3 d) {
    vec3 a = abs(d);
    if (a.x >= a.y && a.x >= a.z) return d.x >= 0.0 ? 0 : 1;
    if (a.y >= a.z) return d.y >= 0.0 ? 2 : 3;
    return d.z >= 0.0 ? 4 : 5;
}

// Texels along an edge of a layer.
float shadowEdge(int layer) {
    return float(shadowLayers.layers[layer].edge);
}

ivec2 shadowCorner(uint layer) {
    uint corner = shadowLayers.layers[layer].corner;
    return ivec2(corner & 0xffffu, corner >> 16);
}

// Where the texture has a layer's position `at`. A layer that is a part of a page has neighbours: a lookup of
// this radius [texels] stays inside.
vec3 shadowPlace(int layer, vec2 at, float radius) {
    ShadowLayer l = shadowLayers.layers[layer];
    if (l.edge == params.shadow_dim) return vec3(at, l.page);
    vec2 texel = clamp(at * float(l.edge), radius, float(l.edge) - radius) + vec2(shadowCorner(layer));
    return vec3(texel / float(params.shadow_dim), l.page);
}

// World size of a shadow texel at p [m].
float shadowTexel(int layer, Light light, vec3 p) {
    ShadowLayer l = shadowLayers.layers[layer];
    return l.width * (l.perspective > 0.0 ? distance(light.position, p) : 1.0) / float(l.edge);
}

// xy: shadow-map coordinates in [0,1]; z: depth, outside [0,1] beyond the map's ends.
vec3 shadowPositionBeyond(int layer, vec3 p) {
    vec4 c = shadowLayers.layers[layer].view_projection * vec4(p, 1.0);
    vec3 q = c.xyz / max(c.w, 1e-6); // w = 0 in a spot light's plane; no light arrives behind it
    return vec3(q.xy * 0.5 + 0.5, q.z);
}

// The same, with depth clamped as in the map.
vec3 shadowPosition(int layer, vec3 p) {
    vec3 q = shadowPositionBeyond(layer, p);
    return vec3(q.xy, clamp(q.z, 0.0, 1.0));
}

// Unused margin of a finer map [texels], which keeps taps and offsets inside it.
const float SHADOW_BORDER = 8.0;

// The finest layer of a light that shows p.
int shadowLayerOf(Light light, vec3 p) {
    if (castsAround(light)) return light.shadow_view + cubeFace(p - light.position);
    int layer = light.shadow_view;
    if (params.nested_maps == 1 || light.kind != LIGHT_DIRECTIONAL) return layer;
    for (int finer = shadowLayers.layers[layer].finer; finer >= 0; finer = shadowLayers.layers[layer].finer) {
        vec3 aside = abs(shadowPositionBeyond(finer, p) - 0.5);
        if (max(aside.x, max(aside.y, aside.z)) > 0.5 - SHADOW_BORDER / float(params.shadow_dim)) break;
        layer = finer;
    }
    return layer;
}

#endif
