// Materials and their textures. A texture handle is slot << 16 | layer: which array, which layer of it.
// Gradients are always explicit, so that lookups stay defined in divergent control flow and outside
// the fragment stage, where texture() would silently read mip 0.
#ifndef MATERIALS_GLSL
#define MATERIALS_GLSL
#include "common/dielectrics.glsl"

struct Material {
    vec4 base_color;
    vec3 emission; // radiance
    float metallic;
    float roughness;
    float alpha_cutoff; // 0: opaque
    float normal_scale;
    uint flags; // 1: two-sided; from bit 8: number in dielectrics
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

struct Gradient {
    vec2 x;
    vec2 y;
};

vec4 sampleTexture(uint handle, vec2 uv, Gradient g) {
    vec3 at = vec3(uv, float(handle & 0xffffu));
    switch (handle >> 16) {
        case 0: return textureGrad(materialTexture0, at, g.x, g.y);
        case 1: return textureGrad(materialTexture1, at, g.x, g.y);
        case 2: return textureGrad(materialTexture2, at, g.x, g.y);
        case 3: return textureGrad(materialTexture3, at, g.x, g.y);
        case 4: return textureGrad(materialTexture4, at, g.x, g.y);
        case 5: return textureGrad(materialTexture5, at, g.x, g.y);
        case 6: return textureGrad(materialTexture6, at, g.x, g.y);
        case 7: return textureGrad(materialTexture7, at, g.x, g.y);
        case 8: return textureGrad(materialTexture8, at, g.x, g.y);
        case 9: return textureGrad(materialTexture9, at, g.x, g.y);
        case 10: return textureGrad(materialTexture10, at, g.x, g.y);
        case 11: return textureGrad(materialTexture11, at, g.x, g.y);
    }
    return vec4(1.0);
}

vec4 baseColor(Material m, vec2 uv, Gradient g) {
    vec4 c = m.base_color;
    if (m.base_color_texture != NO_TEXTURE) c *= sampleTexture(m.base_color_texture, uv, g);
    return c;
}

vec3 emission(Material m, vec2 uv, Gradient g) {
    vec3 e = m.emission;
    if (m.emission_texture != NO_TEXTURE) e *= sampleTexture(m.emission_texture, uv, g).rgb;
    return e;
}

// (roughness, metallic)
vec2 roughnessMetallic(Material m, vec2 uv, Gradient g) {
    vec2 rm = vec2(m.roughness, m.metallic);
    if (m.metallic_roughness_texture != NO_TEXTURE) rm *= sampleTexture(m.metallic_roughness_texture, uv, g).gb;
    return rm;
}

uint dielectricNumber(Material m) {
    return m.flags >> 8;
}

vec4 dielectric(Material m) {
    return dielectrics.list[dielectricNumber(m)];
}

// Tangent-space normal, not normalised. z is rebuilt, because two-channel formats (BC5) do not store it, and before x and
// y are scaled (glTF 2.0, normalTextureInfo.scale).
vec3 tangentNormal(Material m, vec2 uv, Gradient g) {
    vec2 xy = sampleTexture(m.normal_texture, uv, g).xy * 2.0 - 1.0;
    return vec3(xy * m.normal_scale, sqrt(max(1.0 - dot(xy, xy), 0.0)));
}

#endif
