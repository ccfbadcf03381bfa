// Shared constants and mappings.
#ifndef MATH_GLSL
#define MATH_GLSL

const float PI = 3.14159265359;

// The colour is linear Rec. 709.
float luminance(vec3 c) {
    return dot(c, vec3(0.2126, 0.7152, 0.0722));
}

// Index of the largest component's axis. >= handles ties at 45 degrees.
uint dominantAxis(vec3 v) {
    vec3 a = abs(v);
    if (a.x >= a.y && a.x >= a.z) return 0u;
    return a.y >= a.z ? 1u : 2u;
}

// Octahedral map of the unit sphere to [-1,1]^2 (Cigolle et al. 2014). n: not 0, of any length.
vec2 octahedral(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    if (n.z < 0.0) p = (1.0 - abs(p.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(p, vec2(0.0)));
    return p;
}

vec3 fromOctahedral(vec2 p) {
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(n.xy, vec2(0.0)));
    return normalize(n);
}

#endif
