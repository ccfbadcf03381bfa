// Light that points of the reflective shadow maps send to a surface (Dachsbacher and Stamminger 2005), in
// units of radiance: the paper's sum lacks 1 / pi, and its weights leave the scale open.
#ifndef RSM_GATHER_GLSL
#define RSM_GATHER_GLSL
#include "common/scene.glsl"
#include "common/pattern.glsl"
#include "lights/lights.glsl"
#include "shadow/views.glsl"

uniform sampler2DArray rsmFlux;
uniform sampler2DArray rsmNormal;
uniform sampler2DArray rsmDepth;

// Irradiance at p from the texel at a place of a view, which stands for `share` of the map's area.
vec3 fromTexel(uint view, vec2 at, float share, vec3 p, vec3 n, vec3 lamp) {
    if (any(notEqual(clamp(at, 0.0, 0.99999), at))) return vec3(0.0);
    ivec3 texel = ivec3(at * float(params.rsm_dim), view);
    vec3 flux = texelFetch(rsmFlux, texel, 0).rgb;
    if (flux == vec3(0.0)) return vec3(0.0);
    ShadowView v = shadowViews.views[view];
    vec2 clip = (vec2(texel.xy) + 0.5) / float(params.rsm_dim) * 2.0 - 1.0;
    vec4 h = v.inverse_view_projection * vec4(clip, texelFetch(rsmDepth, texel, 0).r, 1.0);
    vec3 q = h.xyz / h.w, off = p - q;
    float area = mapArea(v) * share;
    float emits = dot(fromOctahedral(texelFetch(rsmNormal, texel, 0).rg), off), receives = -dot(n, off);
    if (emits <= 0.0 || receives <= 0.0) return vec3(0.0);
    // A disc of the point's area instead of the point, so that light stays finite nearby.
    float wide = area * (v.texel_size_and_depth.z > 0.0 ? dot(q - lamp, q - lamp) : 1.0) / PI;
    float d2 = dot(off, off);
    return flux * (area / PI) * emits * receives / (d2 * (d2 + wide));
}

// A directional or spot light: points lie around the surface's own place in the map, denser near it
// (density 1 / radius).
vec3 fromView(uint view, vec3 p, vec3 n, vec3 lamp) {
    vec4 h = shadowViews.views[view].view_projection * vec4(p, 1.0);
    vec2 centre = h.w > 1e-6 ? clamp(h.xy / h.w * 0.5 + 0.5, 0.0, 1.0) : vec2(0.5);
    float radius = params.rsm_radius, number = float(params.rsm_samples);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < params.rsm_samples; i++) {
        vec2 u = r2(uint(i));
        float turn = 2.0 * PI * u.y, share = 2.0 * PI * radius * radius * u.x / number;
        sum += fromTexel(view, centre + radius * u.x * vec2(sin(turn), cos(turn)), share, p, n, lamp);
    }
    return sum;
}

// A lamp that shines around: points lie evenly on its six views.
vec3 fromCube(uint first, vec3 p, vec3 n, vec3 lamp) {
    int number = max(params.rsm_samples / 6, 1);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 6 * number; i++)
        sum += fromTexel(first + uint(i) % 6u, r2(uint(i) / 6u), 1.0 / float(number), p, n, lamp);
    return sum;
}

// Mean radiance over the hemisphere of n.
vec3 rsmLight(vec3 p, vec3 n) {
    vec3 irradiance = vec3(0.0);
    for (uint i = 0; i < sceneInfo.light_count; i++) {
        Light light = lights.lights[i];
        if (light.shadow_view < 0) continue;
        uint view = uint(light.shadow_view);
        bool around = light.kind != LIGHT_DIRECTIONAL && light.kind != LIGHT_SPOT;
        irradiance += around ? fromCube(view, p, n, light.position) : fromView(view, p, n, light.position);
    }
    return irradiance / PI;
}

#endif
