// The G-buffer: the surface that each pixel sees, between the pass that writes it (gbuffer/gbuffer.frag) and those that shade
// it. Every value is 0 or more: where triangles meet in one depth the larger one stays, channel by channel, whatever their order. What is
// then shaded may be a mixture of both, on the viewer's side.
#ifndef GBUFFER_GLSL
#define GBUFFER_GLSL

// Octahedral map of the unit sphere to [0,1]^2 (Cigolle et al. 2014).
vec2 packNormal(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    if (n.z < 0.0) p = (1.0 - abs(p.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(p, vec2(0.0)));
    return p * 0.5 + 0.5;
}

vec3 unpackNormal(vec2 p) {
    p = p * 2.0 - 1.0;
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(n.xy, vec2(0.0)));
    return normalize(n);
}

#endif
