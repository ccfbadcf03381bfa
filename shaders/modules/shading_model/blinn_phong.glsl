// Normalised Blinn-Phong lobe, with its exponent matched to the width of GGX.

// Width of the GGX lobe that this one matches.
float ggxAlpha(float roughness) {
    return roughness * roughness;
}

// As in the thesis: the lobe does not dim the base below it, and multiple scattering is lost.
Surface layered(Surface s, vec3 v) {
    return s;
}

vec3 specularBrdf(Surface s, vec3 v, vec3 l) {
    float n_h = max(dot(s.normal, normalize(v + l)), 0.0);
    float a2 = pow(s.roughness, 4.0);
    float exponent = 2.0 / a2 - 2.0;
    // At roughness 1 the exponent is 0, and pow(0, 0) is undefined.
    return s.f0 * (exponent + 8.0) / (8.0 * PI) * pow(max(n_h, 1e-9), exponent);
}

// BRDF * cosine / pdf of a direction sampled from the visible normals. v, l and half_way are in the normal's
// frame. g1: Smith's masking of v.
vec3 lobeWeight(Surface s, mat3 frame, vec3 v, vec3 l, vec3 half_way, float g1) {
    float density = g1 * distribution(half_way.z, s.roughness) / (4.0 * v.z);
    return specularBrdf(s, frame * v, frame * l) * l.z / max(density, 1e-20);
}

// Mean over all light directions; the lobe is normalised.
vec3 sphericalAlbedo(vec3 base, vec3 f0, float f90, float roughness) {
    return min(base + f0, 1.0);
}
