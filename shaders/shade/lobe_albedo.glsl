// Directional albedo of the specular lobe, tabulated by shade/specular_albedo.comp.
#include "common/brdf.glsl" // before the guard: a shading model includes this file itself
#ifndef LOBE_ALBEDO_GLSL
#define LOBE_ALBEDO_GLSL

uniform sampler2D specularAlbedo; // x: root of the cosine at the viewer, y: roughness

// The lobe reflects f0 * x + f90 * y of a uniform sky.
vec2 lobeAlbedo(float cosine, float roughness) {
    vec2 size = vec2(textureSize(specularAlbedo, 0));
    vec2 at = vec2(sqrt(clamp(cosine, 0.0, 1.0)), roughness);
    return textureLod(specularAlbedo, (at * (size - 1.0) + 0.5) / size, 0.0).rg;
}

// Fraction of a uniform sky that a surface's lobe reflects to the viewer.
vec3 lobeReflectance(Surface s, vec3 v) {
    vec2 albedo = lobeAlbedo(dot(s.normal, v), s.roughness);
    return (s.f0 * albedo.x + s.f90 * albedo.y) * s.multiple;
}

#endif
