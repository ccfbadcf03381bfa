// Shadow lookup for surfaces. The bias is a distance in shadow texels, never in metres.
#ifndef SHADOW_GLSL
#define SHADOW_GLSL
#include "shadow_views.glsl"

uniform sampler2DArrayShadow shadowCompare;

// Visibility in [0,1] of a light from p on a surface with geometric normal n (facing the viewer).
// A texel of radius r hides up to r tan(theta) of depth on a slope; moving p by r sin(theta) along n clears it.
float shadowVisibility(Light light, vec3 p, vec3 n, vec3 to_light) {
    if (light.shadow_view < 0) return 1.0;
    int view = shadowViewOf(light, p);
    float radius = params.shadow_bias * shadowTexel(view, light, p);
    float cosine = dot(n, to_light);
    vec3 side = cosine < 0.0 ? -n : n; // light from behind: a thin two-sided sheet
    vec3 from = p + radius * (side * sqrt(max(1.0 - cosine * cosine, 0.0)) + 0.5 * to_light);
    vec3 q = shadowPosition(view, from);
    if (SHADOW_FILTER == SHADOW_FILTER_NEAREST) return textureGrad(shadowCompare, vec4(q.xy, view, q.z), vec2(0.0), vec2(0.0));
    float texel = 1.0 / float(params.shadow_dim);
    int r = SHADOW_FILTER == SHADOW_FILTER_PCF3 ? 1 : 2;
    float sum = 0.0;
    for (int y = -r; y <= r; y++)
        for (int x = -r; x <= r; x++) sum += textureGrad(shadowCompare, vec4(q.xy + vec2(x, y) * texel, view, q.z), vec2(0.0), vec2(0.0));
    return sum / float((2 * r + 1) * (2 * r + 1));
}

#endif
