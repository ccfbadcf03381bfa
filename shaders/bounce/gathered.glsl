// Gathered light of a voxel side, packed into two words.
#ifndef BOUNCE_GATHERED_GLSL
#define BOUNCE_GATHERED_GLSL
#include "common/math.glsl"
#include "history/rounds.glsl"

struct SideLight {
    vec3 light; // mean radiance over the hemisphere
    uint updates; // at most 63, see history/rounds.glsl
    float first; // fraction of the light that arrived in the first update
};

// Three halves, six bits of updates, ten bits of the fraction.
uvec2 packSideLight(SideLight g) {
    uint state = g.updates | uint(clamp(g.first, 0.0, 1.0) * 1023.0 + 0.5) << 6;
    g.light = min(g.light, 65504.0);
    return uvec2(packHalf2x16(g.light.rg), packHalf2x16(vec2(g.light.b, 0.0)) | state << 16);
}

SideLight sideLightOf(uvec2 packed) {
    uint state = packed.y >> 16;
    vec3 light = vec3(unpackHalf2x16(packed.x), unpackHalf2x16(packed.y).x);
    return SideLight(light, state & 63u, float(state >> 6) / 1023.0);
}

// The side after an update, which is averaged with the rounds before. The light of its first update stays in
// it.
SideLight updated(SideLight last, vec3 light) {
    uint updates = min(last.updates + 1, mostUpdates());
    if (updates > SHORT_ROUNDS) light = mix(last.light, light, weightOfRound(updates - SHORT_ROUNDS));
    float first = last.updates == 0 ? 1.0 : last.first * luminance(last.light) / max(luminance(light), 1e-20);
    return SideLight(light, updates, first);
}

#endif
