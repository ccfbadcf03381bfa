// A cone that stands for the lobe of the BRDF.
#include "common/lobe_albedo.glsl"

// Where a rough lobe's weight lies: between the mirror direction and the normal (Lagarde and de Rousiers 2014, Section
// 4.9.3, with Smith's term).
vec3 specularDirection(Surface s, vec3 v) {
    float alpha = ggxAlpha(s.roughness);
    return normalize(mix(s.normal, reflect(-v, s.normal), (1.0 - alpha) * (sqrt(1.0 - alpha) + alpha)));
}

// Half of a GGX lobe lies within 2 atan(alpha) of the mirror direction.
float specularHalfAngle(Surface s) {
    return min(2.0 * atan(ggxAlpha(s.roughness)), PI / 3.0);
}

// How much of the cone's radiance goes to the viewer: the integral of the BRDF in use.
vec3 specularWeight(Surface s, vec3 v) {
    return lobeReflectance(s, v);
}
