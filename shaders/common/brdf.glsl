// Reflectance of a surface. modules/shading_model defines the specular lobe and its layering over the diffuse
// base. Functions return the BRDF [1/sr]; the caller multiplies by irradiance and cosine.
#ifndef BRDF_GLSL
#define BRDF_GLSL
#include "common/math.glsl"

struct Surface {
    vec3 normal; // shading normal, facing the viewer
    vec3 albedo; // diffuse: base colour * (1 - metallic), less the reflectance of the lobe above it
    vec3 f0; // reflectance at normal incidence
    float f90; // reflectance at grazing angles: 1, or less if the author dims it
    float roughness; // clamped: 0 makes GGX 0/0
    vec3 multiple; // factor of the lobe for multiple scattering between its facets
};

// Refractive index 1.5: glass and nearly every other dielectric.
const vec4 PLAIN_DIELECTRIC = vec4(vec3(0.04), 1.0);

// Puts the lobe over the diffuse base. v: to the viewer.
Surface layered(Surface s, vec3 v);

// dielectric: f0 and f90 (in a) of the non-metallic part.
Surface bareSurface(vec3 normal, vec3 base_color, float roughness, float metallic, vec4 dielectric) {
    vec3 f0 = mix(dielectric.rgb, base_color, metallic);
    float f90 = dielectric.a + (1.0 - dielectric.a) * metallic; // exactly 1 if both are
    return Surface(normal, base_color * (1.0 - metallic), f0, f90, clamp(roughness, 0.03, 1.0), vec3(1.0));
}

Surface makeSurface(vec3 normal, vec3 base_color, float roughness, float metallic, vec4 dielectric, vec3 v) {
    return layered(bareSurface(normal, base_color, roughness, metallic, dielectric), v);
}

vec3 fresnel(Surface s, float cosine) {
    return s.f0 + (s.f90 - s.f0) * pow(clamp(1.0 - cosine, 0.0, 1.0), 5.0);
}

// Width of the lobe, defined by the shading model.
float ggxAlpha(float roughness);

// Trowbridge-Reitz.
float distribution(float n_h, float roughness) {
    float alpha = ggxAlpha(roughness);
    float a2 = alpha * alpha;
    float d = n_h * n_h * (a2 - 1.0) + 1.0;
    return a2 / (PI * d * d);
}

// Approximate solid angle of the lobe [sr]; seen from above, its pdf at the centre is D / 4.
float lobeSolidAngle(Surface s) {
    float alpha = ggxAlpha(s.roughness);
    return min(4.0 * PI * alpha * alpha, PI);
}

// Smith-Schlick G / (4 n.l n.v), k = (roughness + 1)^2 / 8; the cosines cancel.
float visibility(float n_l, float n_v, float roughness) {
    float k = (roughness + 1.0) * (roughness + 1.0) / 8.0;
    return 0.25 / ((n_l * (1.0 - k) + k) * (n_v * (1.0 - k) + k));
}

vec3 diffuseBrdf(Surface s) {
    return s.albedo / PI;
}

#include "modules/shading_model.glsl"

#endif
