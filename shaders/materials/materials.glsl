// Materials and their textures. A texture handle holds the layer of an array in 16 bits, the number of the
// array in 4, and sampling flags above them. Gradients are always explicit: lookups stay defined in divergent
// control flow and outside the fragment stage, where texture() would silently read mip 0.
#ifndef MATERIALS_GLSL
#define MATERIALS_GLSL
#include "materials/dielectrics.glsl"
#include "common/scene.glsl"

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

uniform sampler2DArray materialTexture0;
uniform sampler2DArray materialTexture1;
uniform sampler2DArray materialTexture2;
uniform sampler2DArray materialTexture3;
uniform sampler2DArray materialTexture4;
uniform sampler2DArray materialTexture5;
uniform sampler2DArray materialTexture6;
uniform sampler2DArray materialTexture7;
uniform sampler2DArray materialTexture8;
uniform sampler2DArray materialTexture9;
uniform sampler2DArray materialTexture10;
uniform sampler2DArray materialTexture11;

const uint NO_TEXTURE = 0xffffffffu;

// Material flags: vertex colours multiply the base colour (COLORED), the emission (TINTED).
const uint COLORED = 2u, TINTED = 4u;

// Bits of handles: wrap modes of u and v, 2 bits each (0 repeats), ...
const uint WRAP_U = 20u, WRAP_V = 22u;
const uint CLAMPED = 1u, MIRRORED = 2u;
// ... no filter for magnified texels, the second set of coordinates, an anisotropic sampler.
const uint NEAREST = 1u << 24, SECOND_SET = 1u << 25, ANISOTROPIC = 1u << 26;
const uint FOLDED = 0x1f00000u; // any mode that the sampler does not implement


// Inputs of a texture lookup on a surface: two sets of texture coordinates and the vertex colour.
struct Place {
    vec4 uv;
    vec4 color;
};

// Footprint of a lookup: derivatives of both sets of texture coordinates.
struct Gradient {
    vec4 x;
    vec4 y;
};

bool isColored(Material m) {
    return COLORS && (m.flags & (COLORED | TINTED)) != 0;
}

bool usesSecondSet(uint handle) {
    return LOOKUPS && handle != NO_TEXTURE && (handle & SECOND_SET) != 0;
}

#include "materials/textures.glsl"

vec4 baseColor(Material m, Place at, Gradient g) {
    vec4 c = m.base_color;
    if (COLORS && (m.flags & COLORED) != 0) c *= at.color;
    if (m.base_color_texture != NO_TEXTURE) c *= sampleTexture(m.base_color_texture, at.uv, g);
    return c;
}

vec3 emission(Material m, Place at, Gradient g) {
    vec3 e = m.emission;
    if (COLORS && (m.flags & TINTED) != 0) e *= at.color.rgb;
    if (m.emission_texture != NO_TEXTURE) e *= sampleTexture(m.emission_texture, at.uv, g).rgb;
    return e;
}

// (roughness, metallic)
vec2 roughnessMetallic(Material m, Place at, Gradient g) {
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
vec3 tangentNormal(Material m, Place at, Gradient g) {
    vec2 xy = sampleTexture(m.normal_texture, at.uv, g).xy * 2.0 - 1.0;
    return vec3(xy * m.normal_scale, sqrt(max(1.0 - dot(xy, xy), 0.0)));
}

#endif
