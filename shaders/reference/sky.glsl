// Importance sampling of the sky image by luminance, combined with the directions that surfaces sample (Veach
// and Guibas 1995, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", the balance
// heuristic).
#ifndef REFERENCE_SKY_GLSL
#define REFERENCE_SKY_GLSL
#include "reference/guide.glsl"
#include "lights/sky.glsl"

// Layout: width, height, 2 unused words; radiance around the sun, 1 unused word; cumulative sums of rows,
// from 0 to 1; for each row, cumulative sums of its texels; texels as half floats, 2 words each, with bit 48
// set for the sun.
layout(std430) readonly buffer SkyTexels { uint words[]; } skyTexels;

const uint SKY_AROUND = 4, SKY_ROWS = 8;

// Radiance from a direction. The sun counts as direct light, like a light.
struct SkyShine {
    vec3 sky;
    vec3 sun;
    float density; // pdf of drawSky [1/sr]
};

// Light reflected to the viewer.
struct SkyLight {
    vec3 diffuse;
    vec3 specular;
    vec3 direct; // from the sun
};

const SkyLight NO_SKY_LIGHT = SkyLight(vec3(0.0), vec3(0.0), vec3(0.0));

bool skyHasPicture() {
    return sceneInfo.sky_turn >= 0.0;
}

float skySum(uint i) {
    return uintBitsToFloat(skyTexels.words[i]);
}

// The first of `count` intervals with an end above u. Cumulative sums begin at `first`.
uint skyPart(uint first, uint count, float u) {
    uint low = 0, high = count - 1;
    while (low < high) {
        uint middle = (low + high) / 2;
        if (skySum(first + middle + 1) > u) high = middle;
        else low = middle + 1;
    }
    return low;
}

SkyShine skyTexel(uvec2 at, float polar) {
    uvec2 size = uvec2(skyTexels.words[0], skyTexels.words[1]);
    uint row = SKY_ROWS + size.y + 1 + at.y * (size.x + 1);
    uint texel = SKY_ROWS + size.y + 1 + size.y * (size.x + 1) + 2 * (at.y * size.x + at.x);
    uint first = skyTexels.words[texel], second = skyTexels.words[texel + 1];
    vec3 radiance = vec3(unpackHalf2x16(first), unpackHalf2x16(second & 0xffffu).x), around = radiance;
    if (second >> 16 != 0) around = vec3(skySum(SKY_AROUND), skySum(SKY_AROUND + 1), skySum(SKY_AROUND + 2));
    float share = (skySum(SKY_ROWS + at.y + 1) - skySum(SKY_ROWS + at.y))
        * (skySum(row + at.x + 1) - skySum(row + at.x));
    float density = share * float(size.x) * float(size.y) / (2.0 * PI * PI * max(sin(polar), 1e-7));
    return SkyShine(sceneInfo.sky * around, sceneInfo.sky * (radiance - around), density);
}

// Sky radiance along d, for a ray that leaves the scene.
SkyShine skyShine(vec3 d) {
    uvec2 size = uvec2(skyTexels.words[0], skyTexels.words[1]);
    vec2 uv = skyDirection(d);
    return skyTexel(min(uvec2(vec2(fract(uv.x), uv.y) * vec2(size)), size - 1u), uv.y * PI);
}

// Samples a direction in proportion to the image's luminance.
SkyShine drawSky(vec4 u, out vec3 d) {
    uvec2 size = uvec2(skyTexels.words[0], skyTexels.words[1]);
    uint y = skyPart(SKY_ROWS, size.y, u.x);
    uint x = skyPart(SKY_ROWS + size.y + 1 + y * (size.x + 1), size.x, u.y);
    vec2 uv = (vec2(x, y) + u.zw) / vec2(size);
    float polar = uv.y * PI, azimuth = (uv.x - 0.5 - sceneInfo.sky_turn) * 2.0 * PI;
    d = vec3(sin(azimuth) * sin(polar), cos(polar), -cos(azimuth) * sin(polar));
    return skyTexel(uvec2(x, y), polar);
}

// Balance-heuristic weight of a ray along d that a lobe sampled with this density.
float lobeShare(SkyShine shine, float density) {
    return density / max(density + shine.density, 1e-30);
}

// Light of one direction sampled from the sky. samples: expected number of directions that the diffuse
// and the specular lobe sample here. At a path's end (only_sun) they sample none, and only the sun counts,
// like a light.
SkyLight skyLight(SurfaceHit h, uint guide, vec2 samples, bool only_sun, vec4 u) {
    Surface s = h.surface;
    vec3 d;
    SkyShine shine = drawSky(u, d);
    float cosine = dot(s.normal, d);
    if (cosine <= 0.0 || dot(h.face, d) <= 0.0 || shine.density <= 0.0 || only_sun && shine.sun == vec3(0.0))
        return NO_SKY_LIGHT;
    if (blocked(Ray(offsetPoint(h.position, h.face), d, 1e30))) return NO_SKY_LIGHT;
    vec2 densities = shine.density
        + samples * vec2(diffuseDirectionDensity(guide, s, d), specularDensity(s, h.view, d));
    vec3 diffuse = diffuseBrdf(s) * cosine / densities.x,
        specular = specularBrdf(s, h.view, d) * cosine / densities.y;
    vec3 sky = only_sun ? vec3(0.0) : shine.sky;
    return SkyLight(diffuse * sky, specular * sky, (diffuse + specular) * shine.sun);
}

#endif
