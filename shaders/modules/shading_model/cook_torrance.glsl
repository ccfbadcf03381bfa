// GGX microfacets (thesis, Section 4.5.1; Karis 2013).

// The thesis uses the roughness itself (equation for D, Section 4.5.1); Burley 2012 squares it.
float ggxAlpha(float roughness) {
    return roughness;
}

// As in the thesis: the lobe does not dim the base below it, and multiple scattering is lost.
Surface layered(Surface s, vec3 v) {
    return s;
}

vec3 specularBrdf(Surface s, vec3 v, vec3 l) {
    vec3 h = normalize(v + l);
    float n_h = max(dot(s.normal, h), 0.0);
    float v_h = max(dot(v, h), 0.0);
    float n_l = max(dot(s.normal, l), 1e-4);
    float n_v = max(dot(s.normal, v), 1e-4);
    return distribution(n_h, s.roughness) * visibility(n_l, n_v, s.roughness) * fresnel(s, v_h);
}

// BRDF * cosine / pdf of a direction sampled from the visible normals. v, l and half_way are in the normal's
// frame. g1: Smith's masking of v. D cancels between the BRDF and the pdf, g1 D / (4 n.v).
vec3 lobeWeight(Surface s, mat3 frame, vec3 v, vec3 l, vec3 half_way, float g1) {
    return fresnel(s, dot(v, half_way)) * visibility(l.z, v.z, s.roughness) * 4.0 * l.z * v.z / g1;
}

// Mean over all light directions: the base, and f0 a + f90 b, fitted to the integral over roughness within
// 0.003.
vec3 sphericalAlbedo(vec3 base, vec3 f0, float f90, float roughness) {
    float r = clamp(roughness, 0.0, 1.0);
    float a = 0.8287 + r * (-0.3363 + r * (-0.3395 + r * 0.2235)),
        b = 0.023 + r * (-0.062 + r * (0.0689 - r * 0.0282));
    return min(base + f0 * a + b * f90, 1.0);
}
