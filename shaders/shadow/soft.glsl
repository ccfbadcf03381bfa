// Shadows of rectangles and discs from the map of their centre: percentage-closer soft shadows (Fernando
// 2005), with each texel's surface projected back onto the light to see whether it hides any of it (Guennebaud
// et al. 2006, "Real-time Soft Shadow Mapping by Backprojection"). Surfaces that the centre does not see cast
// no shadow.
#ifndef SHADOW_SOFT_GLSL
#define SHADOW_SOFT_GLSL
#include "shadow/layers.glsl"
#include "common/pattern.glsl"

const uint SEARCH_TAPS = 32, SHADE_TAPS = 64;

// The surface that the centre of the light sees towards q.
vec3 surfaceTowards(Light light, vec3 q) {
    int layer = light.shadow_view + cubeFace(q - light.position);
    mat4 m = shadowLayers.layers[layer].view_projection;
    vec4 start = m * vec4(light.position, 1.0), ahead = m * vec4(q - light.position, 0.0);
    vec2 at = ahead.xy / ahead.w * 0.5 + 0.5;
    float depth = shadowDepth(layer, at);
    // depth = (start.z + t ahead.z) / (t ahead.w)
    return light.position + (q - light.position) * (start.z / (depth * ahead.w - ahead.z));
}

// Share of the way from p to the light at which a surface at q hides a point of the light; 0: it hides none.
float hiddenAt(Light light, vec3 p, vec3 n, float clear, vec3 q) {
    if (dot(q - p, n) < clear) return 0.0;
    float share = dot(q - p, light.direction) / dot(light.position - p, light.direction);
    return share > 0.0 && share < 0.999 && isOnArea(light, p + (q - p) / share) ? share : 0.0;
}

// Visible fraction of a light from p on a surface with geometric normal n.
float visibleArea(Light light, vec3 p, vec3 n) {
    float clear = 1.5 * shadowTexel(shadowLayerOf(light, p), light, p);
    float sum = 0.0, found = 0.0;
    for (uint i = 0; i < SEARCH_TAPS; i++) {
        vec2 u = r2(i);
        float share = (float(i) + 0.5) / float(SEARCH_TAPS);
        vec3 q = surfaceTowards(light, mix(p, areaPoint(light, u), share));
        float at = hiddenAt(light, p, n, clear, q);
        sum += at;
        found += at > 0.0 ? 1.0 : 0.0;
    }
    if (found == 0.0) return 1.0;
    float share = sum / found, hidden = 0.0;
    for (uint i = 0; i < SHADE_TAPS; i++) {
        vec3 q = surfaceTowards(light, mix(p, areaPoint(light, r2(i)), share));
        hidden += hiddenAt(light, p, n, clear, q) > 0.0 ? 1.0 : 0.0;
    }
    return 1.0 - hidden / float(SHADE_TAPS);
}

#endif
