// Shadows of rectangles and discs from the map of their centre: percentage-closer soft shadows (Fernando
// 2005), with each texel's surface projected back onto the light to see whether it hides any of it
// (Guennebaud et al. 2006, "Real-time Soft Shadow Mapping by Backprojection"). Surfaces that the centre does
// not see cast no shadow.
#ifndef SHADOW_SOFT_GLSL
#define SHADOW_SOFT_GLSL
#include "shadow/layers.glsl"
#include "common/pattern.glsl"

// 16 and 64 are faster by 0.4 ms for two lights at 1920x1080 (NVIDIA H100) and as accurate behind large
// blockers, but miss narrow ones: shadows of a bar under a disc are off by nearly twice as much.
const uint SEARCH_TAPS = 32, SHADE_TAPS = 64;

// z of the centre of the light in clip space, where x, y and w are 0; the same in all faces.
float startOf(Light light) {
    return (shadowLayers.layers[light.shadow_view].view_projection * vec4(light.position, 1.0)).z;
}

// The surface that the centre of the light sees towards q.
vec3 surfaceTowards(Light light, float start, vec3 q) {
    vec3 d = q - light.position;
    int layer = light.shadow_view + cubeFace(d);
    vec4 ahead = shadowLayers.layers[layer].view_projection * vec4(d, 0.0);
    float depth = shadowDepth(layer, ahead.xy / ahead.w * 0.5 + 0.5);
    return light.position + d * (start / (depth * ahead.w - ahead.z)); // depth = (start + t z) / (t w)
}

// Share of the way from p to the light at which a surface at q hides a point of the light; 0: it hides none.
float hiddenAt(Light light, vec3 p, vec3 n, float clear, vec3 q) {
    if (dot(q - p, n) < clear) return 0.0;
    float share = dot(q - p, light.direction) / dot(light.position - p, light.direction);
    return share > 0.0 && share < 0.999 && isOnArea(light, p + (q - p) / share) ? share : 0.0;
}

// Visible fraction, from p on a surface with geometric normal n, of what a light shows above the horizon.
float visibleArea(Light light, vec3 p, vec3 n) {
    float clear = 1.5 * shadowTexel(shadowLayerOf(light, p), light, p);
    float sum = 0.0, found = 0.0, start = startOf(light);
    for (uint i = 0; i < SEARCH_TAPS; i++) {
        vec3 x = areaPoint(light, r2(i));
        if (dot(x - p, n) <= 0.0) continue;
        float share = (float(i) + 0.5) / float(SEARCH_TAPS);
        float at = hiddenAt(light, p, n, clear, surfaceTowards(light, start, mix(p, x, share)));
        sum += at;
        found += at > 0.0 ? 1.0 : 0.0;
    }
    if (found == 0.0) return 1.0;
    float share = sum / found, hidden = 0.0, taken = 0.0;
    for (uint i = 0; i < SHADE_TAPS; i++) {
        vec3 x = areaPoint(light, r2(i));
        if (dot(x - p, n) <= 0.0) continue;
        taken += 1.0;
        vec3 q = surfaceTowards(light, start, mix(p, x, share));
        hidden += hiddenAt(light, p, n, clear, q) > 0.0 ? 1.0 : 0.0;
    }
    return 1.0 - hidden / max(taken, 1.0);
}

#endif
