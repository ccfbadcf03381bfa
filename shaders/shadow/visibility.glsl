// Shadow lookup for surfaces. The bias is measured in shadow texels, never in metres.
#ifndef SHADOW_GLSL
#define SHADOW_GLSL
#include "shadow/layers.glsl"

// Defines shadowLit: 0 to 1, lit fraction of a depth at a position of a layer.
#include "modules/shadow_lookup.glsl"

// Mean of the taps around `at`. slope: change of depth over the receiver [depth per map width].
float shadowTaps(int layer, vec3 at, vec2 slope) {
    float texel = 1.0 / shadowEdge(layer);
    int r = SHADOW_FILTER == SHADOW_FILTER_NEAREST ? 0
        : SHADOW_FILTER == SHADOW_FILTER_PCF3 ? 1
        : 2;
    float sum = 0.0;
    for (int y = -r; y <= r; y++)
        for (int x = -r; x <= r; x++) {
            vec2 offset = vec2(x, y) * texel;
            sum += shadowLit(layer, vec3(at.xy + offset, at.z + dot(slope, offset)));
        }
    return sum / float((2 * r + 1) * (2 * r + 1));
}

// Lookup position for p, offset from the surface. A texel of radius r hides up to r tan(theta) of depth on a
// slope; moving p by r sin(theta) along n clears it.
vec3 offSurface(vec3 p, vec3 n, vec3 to_light, float radius) {
    float cosine = dot(n, to_light);
    vec3 side = cosine < 0.0 ? -n : n; // light from behind: a thin two-sided sheet
    return p + radius * (side * sqrt(max(1.0 - cosine * cosine, 0.0)) + 0.5 * to_light);
}

// Defines lightVisibility: 0 to 1, of a light from p on a surface with geometric normal n (facing the
// viewer).
#include "modules/shadow_receiver.glsl"

#endif
