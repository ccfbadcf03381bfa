// Textures of materials. A texture handle holds the layer of an array in 16 bits, the number of the
// array in 4, and sampling flags above them. Gradients are always explicit: lookups stay defined in divergent
// control flow and outside the fragment stage, where texture() would silently read mip 0.
#ifndef MATERIAL_TEXTURES_GLSL
#define MATERIAL_TEXTURES_GLSL
#include "common/scene.glsl"

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

// Bits of handles: wrap modes of u and v, 2 bits each (0 repeats), ...
const uint WRAP_U = 20u, WRAP_V = 22u;
const uint CLAMPED = 1u, MIRRORED = 2u;
// ... no filter for magnified texels, the second set of coordinates, an anisotropic sampler.
const uint NEAREST = 1u << 24, SECOND_SET = 1u << 25, ANISOTROPIC = 1u << 26;
const uint FOLDED = 0x1f00000u; // any mode that the sampler does not implement

// Footprint of a lookup: derivatives of both sets of texture coordinates.
struct Gradient {
    vec4 x;
    vec4 y;
};

bool usesSecondSet(uint handle) {
    return LOOKUPS && handle != NO_TEXTURE && (handle & SECOND_SET) != 0;
}

vec2 texelsOf(uint handle) {
    switch (handle >> 16 & 15u) {
        case 0: return vec2(textureSize(materialTexture0, 0).xy);
        case 1: return vec2(textureSize(materialTexture1, 0).xy);
        case 2: return vec2(textureSize(materialTexture2, 0).xy);
        case 3: return vec2(textureSize(materialTexture3, 0).xy);
        case 4: return vec2(textureSize(materialTexture4, 0).xy);
        case 5: return vec2(textureSize(materialTexture5, 0).xy);
        case 6: return vec2(textureSize(materialTexture6, 0).xy);
        case 7: return vec2(textureSize(materialTexture7, 0).xy);
        case 8: return vec2(textureSize(materialTexture8, 0).xy);
        case 9: return vec2(textureSize(materialTexture9, 0).xy);
        case 10: return vec2(textureSize(materialTexture10, 0).xy);
        case 11: return vec2(textureSize(materialTexture11, 0).xy);
    }
    return vec2(1.0);
}

float folded(uint wrap, float t, float margin) {
    if (wrap == 0) return t;
    float inside = wrap == MIRRORED ? 1.0 - abs(1.0 - mod(t, 2.0)) : t;
    return clamp(inside, margin, 1.0 - margin);
}

// Maps coordinates so that the repeating, filtering sampler gives the result of the texture's own wrap modes.
// Edges move inwards by half a texel of the level and footprint, so that nothing bleeds in from the opposite
// edge.
void fold(uint handle, inout vec2 uv, inout vec2 x, inout vec2 y) {
    vec2 texels = texelsOf(handle);
    float a = length(x * texels), b = length(y * texels), longest = max(a, b);
    float level = max(min(a, b), longest / ((handle & ANISOTROPIC) != 0 ? 16.0 : 1.0));
    vec2 covered = max(max(abs(x), abs(y)) * texels, exp2(ceil(log2(max(level, 1.0)))));
    vec2 margin = min(0.5 * covered / texels, 0.5);
    uv = vec2(folded(handle >> WRAP_U & 3u, uv.x, margin.x), folded(handle >> WRAP_V & 3u, uv.y, margin.y));
    if ((handle & NEAREST) != 0 && longest <= 1.0) {
        uv = (floor(uv * texels) + 0.5) / texels;
        x = y = vec2(0.0);
    }
}

vec4 sampleTexture(uint handle, vec4 sets, Gradient g) {
    bool second = usesSecondSet(handle);
    vec2 uv = second ? sets.zw : sets.xy,
        x = second ? g.x.zw : g.x.xy,
        y = second ? g.y.zw : g.y.xy;
    if (LOOKUPS && (handle & FOLDED) != 0) fold(handle, uv, x, y);
    vec3 at = vec3(uv, float(handle & 0xffffu));
    switch (handle >> 16 & 15u) {
        case 0: return textureGrad(materialTexture0, at, x, y);
        case 1: return textureGrad(materialTexture1, at, x, y);
        case 2: return textureGrad(materialTexture2, at, x, y);
        case 3: return textureGrad(materialTexture3, at, x, y);
        case 4: return textureGrad(materialTexture4, at, x, y);
        case 5: return textureGrad(materialTexture5, at, x, y);
        case 6: return textureGrad(materialTexture6, at, x, y);
        case 7: return textureGrad(materialTexture7, at, x, y);
        case 8: return textureGrad(materialTexture8, at, x, y);
        case 9: return textureGrad(materialTexture9, at, x, y);
        case 10: return textureGrad(materialTexture10, at, x, y);
        case 11: return textureGrad(materialTexture11, at, x, y);
    }
    return vec4(1.0);
}

#endif
