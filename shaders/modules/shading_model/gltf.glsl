// The BRDF of glTF 2.0 (Appendix B): GGX microfacets with height-correlated masking over a diffuse base.
//
// The base receives the light that the lobe does not reflect: 1 minus the lobe's directional albedo at the
// viewer. The specification's sample weight, 1 - F(v.h), returns up to 1.9 times the light of a white sky at
// a dielectric's rim; this one returns exactly 1. It is not reciprocal: the weight depends on the viewer and
// not on the light.
#include "shade/lobe_albedo.glsl"

#ifndef SINGLE_SCATTERING
const bool MULTIPLE_SCATTERING = true;
#else
const bool MULTIPLE_SCATTERING = false;
#endif

// Width of the lobe (Burley 2012).
float ggxAlpha(float roughness) {
    return roughness * roughness;
}

// Adds multiple scattering between the facets (Turquin 2019, "Practical multiple scattering compensation for
// microfacet models", Equation 16), then puts the lobe over the base.
Surface layered(Surface s, vec3 v) {
    vec2 albedo = lobeAlbedo(dot(s.normal, v), s.roughness);
    if (MULTIPLE_SCATTERING) s.multiple = 1.0 + s.f0 * (1.0 / (albedo.x + albedo.y) - 1.0);
    s.albedo *= max(1.0 - lobeReflectance(s, v), 0.0);
    return s;
}

// Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", Equation 99, over 4
// n.l n.v.
float correlatedVisibility(float n_l, float n_v, float alpha) {
    float a2 = alpha * alpha;
    float of_view = n_l * sqrt(a2 + (1.0 - a2) * n_v * n_v),
        of_light = n_v * sqrt(a2 + (1.0 - a2) * n_l * n_l);
    return 0.5 / max(of_view + of_light, 1e-7);
}

vec3 specularBrdf(Surface s, vec3 v, vec3 l) {
    vec3 h = normalize(v + l);
    float n_h = max(dot(s.normal, h), 0.0);
    float v_h = max(dot(v, h), 0.0);
    float n_l = max(dot(s.normal, l), 1e-4);
    float n_v = max(dot(s.normal, v), 1e-4);
    float seen = distribution(n_h, s.roughness) * correlatedVisibility(n_l, n_v, ggxAlpha(s.roughness));
    return seen * fresnel(s, v_h) * s.multiple;
}

// BRDF * cosine / pdf of a direction sampled from the visible normals: Fresnel times the masking of l for
// facets that v sees. v, l and half_way are in the normal's frame. g1: Smith's masking of v.
vec3 lobeWeight(Surface s, mat3 frame, vec3 v, vec3 l, vec3 half_way, float g1) {
    float masking = correlatedVisibility(l.z, v.z, ggxAlpha(s.roughness)) * 4.0 * l.z * v.z / g1;
    return fresnel(s, dot(v, half_way)) * masking * s.multiple;
}

// Mean over all light directions: the base, and f0 a + f90 b of single scattering. Fitted to the integral
// over roughness with a largest error of 0.0025.
vec3 sphericalAlbedo(vec3 base, vec3 f0, float f90, float roughness) {
    float r = clamp(roughness, 0.0, 1.0);
    float a = 0.9535 + r * (-0.0685 + r * (0.7963 + r * (-2.8194 + r * 1.5467)));
    float b = 0.0462 + r * (0.0513 + r * (-0.4493 + r * (0.596 - r * 0.2419)));
    vec3 lobe = f0 * a + f90 * b;
    if (MULTIPLE_SCATTERING) lobe += f0 * f0 * (1.0 - a - b);
    return min(base * (1.0 - lobe) + lobe, 1.0);
}
