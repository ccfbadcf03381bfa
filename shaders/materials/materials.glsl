// Materials of surfaces.
#ifndef MATERIALS_GLSL
#define MATERIALS_GLSL
#include "materials/dielectrics.glsl"
#include "common/scene.glsl"
#include "materials/textures.glsl"

struct Material {
    vec4 base_color;
    vec3 emission; // radiance
    float metallic;
    float roughness;
    float alpha_cutoff; // 0: opaque
    float normal_scale;
    uint flags; // 1: two-sided; COLORED; TINTED; from bit 8: index in dielectrics
    uint base_color_texture;
    uint metallic_roughness_texture; // G roughness, B metallic
    uint normal_texture;
    uint emission_texture;
};

layout(std430) readonly buffer Materials { Material materials[]; } materials;

// Material flags: vertex colours multiply the base colour (COLORED), the emission (TINTED).
const uint COLORED = 2u, TINTED = 4u;

// Inputs of a texture lookup on a surface: two sets of texture coordinates and the vertex colour.
struct Interpolants {
    vec4 uv;
    vec4 color;
};

bool isColored(Material m) {
    return COLORS && (m.flags & (COLORED | TINTED)) != 0;
}

vec4 baseColor(Material m, Interpolants at, Gradient g) {
    vec4 c = m.base_color;
    if (COLORS && (m.flags & COLORED) != 0) c *= at.color;
    if (m.base_color_texture != NO_TEXTURE) c *= sampleTexture(m.base_color_texture, at.uv, g);
    return c;
}

vec3 emission(Material m, Interpolants at, Gradient g) {
    vec3 e = m.emission;
    if (COLORS && (m.flags & TINTED) != 0) e *= at.color.rgb;
    if (m.emission_texture != NO_TEXTURE) e *= sampleTexture(m.emission_texture, at.uv, g).rgb;
    return e;
}

// (roughness, metallic)
vec2 roughnessMetallic(Material m, Interpolants at, Gradient g) {
    vec2 rm = vec2(m.roughness, m.metallic);
    if (m.metallic_roughness_texture != NO_TEXTURE)
        rm *= sampleTexture(m.metallic_roughness_texture, at.uv, g).gb;
    return rm;
}

uint dielectricIndex(Material m) {
    return m.flags >> 8;
}

vec4 dielectric(Material m) {
    return dielectrics.list[dielectricIndex(m)];
}

// Tangent-space normal, not normalised. z is reconstructed, because two-channel formats (BC5) do not store
// it. This happens before x and y are scaled (glTF 2.0, normalTextureInfo.scale).
vec3 tangentNormal(Material m, Interpolants at, Gradient g) {
    vec2 xy = sampleTexture(m.normal_texture, at.uv, g).xy * 2.0 - 1.0;
    return vec3(xy * m.normal_scale, sqrt(max(1.0 - dot(xy, xy), 0.0)));
}

#endif
