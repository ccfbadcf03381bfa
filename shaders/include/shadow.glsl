// Shadow lookup for surfaces. The bias is a distance in shadow texels, never in metres.
#ifndef SHADOW_GLSL
#define SHADOW_GLSL
#include "shadow_views.glsl"
#include "frame.glsl"

uniform sampler2DArrayShadow shadowCompare;

// Mean of the taps around q. With the slope of a plane [depth a map's width] they are at texels' centres, which a bilinear
// lookup gives alone.
float shadowTaps(int view, vec3 q, vec2 slope) {
    float texel = 1.0 / float(params.shadow_dim);
    vec3 at = q;
    if (SHADOW_RECEIVER == SHADOW_RECEIVER_PLANE) {
        at.xy = (floor(q.xy * float(params.shadow_dim)) + 0.5) * texel;
        at.z += dot(slope, at.xy - q.xy);
    }
    int r = SHADOW_FILTER == SHADOW_FILTER_NEAREST ? 0 : SHADOW_FILTER == SHADOW_FILTER_PCF3 ? 1 : 2;
    float sum = 0.0;
    for (int y = -r; y <= r; y++)
        for (int x = -r; x <= r; x++) {
            vec2 offset = vec2(x, y) * texel;
            sum += textureGrad(shadowCompare, vec4(at.xy + offset, view, at.z + dot(slope, offset)), vec2(0.0), vec2(0.0));
        }
    return sum / float((2 * r + 1) * (2 * r + 1));
}

// Where p is looked up: off the surface. A texel of radius r hides up to r tan(theta) of depth on a slope; moving p by
// r sin(theta) along n clears it.
vec3 offSurface(vec3 p, vec3 n, vec3 to_light, float radius) {
    float cosine = dot(n, to_light);
    vec3 side = cosine < 0.0 ? -n : n; // light from behind: a thin two-sided sheet
    return p + radius * (side * sqrt(max(1.0 - cosine * cosine, 0.0)) + 0.5 * to_light);
}

// How fast depth in the map grows over the plane through p [a map's width]. It is linear over a plane, in perspective too,
// so it is taken from points far apart, which keeps digits. q: where p is in the map.
vec2 planeSlope(int view, vec3 p, vec3 q, vec3 n, vec3 to_light, float reach) {
    mat3 frame = frameOf(n);
    vec3 a = shadowPositionBeyond(view, p + reach * frame[0]) - q, b = shadowPositionBeyond(view, p + reach * frame[1]) - q;
    float area = a.x * b.y - a.y * b.x;
    vec2 slope = vec2(a.z * b.y - b.z * a.y, b.z * a.x - a.z * b.x) / (abs(area) > 1e-20 ? area : 1e-20);
    // A plane seen edge on has no depth of its own: at most 64 texels deep a texel.
    float towards = abs(shadowPositionBeyond(view, p + reach * to_light).z - q.z) * 64.0;
    return slope * min(1.0, 64.0 * towards / max(length(slope), 1e-20));
}

// Visibility in [0,1] of a light from p on a surface with geometric normal n (facing the viewer). With the plane's depth at
// each texel (Isidoro 2006) a few hundredths of a texel off are enough; without it a whole one, which lets light in where
// surfaces meet.
float shadowVisibility(Light light, vec3 p, vec3 n, vec3 to_light) {
    if (light.shadow_view < 0) return 1.0;
    int view = shadowViewOf(light, p);
    float texel = shadowTexel(view, light, p);
    vec3 from = offSurface(p, n, to_light, params.shadow_bias * texel);
    vec3 q = shadowPositionBeyond(view, from), at = vec3(q.xy, clamp(q.z, 0.0, 1.0));
    if (SHADOW_RECEIVER == SHADOW_RECEIVER_OFFSET) return shadowTaps(view, at, vec2(0.0));
    // 1/64 of the map's width.
    vec2 slope = planeSlope(view, from, q, n, to_light, texel * float(params.shadow_dim) / 64.0);
    return shadowTaps(view, at - vec3(0.0, 0.0, params.shadow_format == SHADOW_FORMAT_D16 ? 1.0 / 65535.0 : 1e-6), slope);
}

#endif
