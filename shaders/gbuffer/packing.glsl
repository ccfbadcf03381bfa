// G-buffer encoding, shared by the passes that write and read it. All values are non-negative: where
// triangles meet at equal depth, the larger value wins in each channel, in any draw order. The shaded surface
// may then mix both, on the viewer's side.
#ifndef GBUFFER_GLSL
#define GBUFFER_GLSL

#include "common/math.glsl"

vec2 packNormal(vec3 n) {
    return octahedral(n) * 0.5 + 0.5;
}

vec3 unpackNormal(vec2 p) {
    return fromOctahedral(p * 2.0 - 1.0);
}

// Metallic and the dielectric's index, in the bits of a 16-bit float. Index 0 stores metallic itself; other
// indices store values above 1, in steps of 1/255 of metallic. The maximum of two codes is one of the two.
const uint HALF_ONE = 0x3c00u;
const uint MOST_DIELECTRICS = 64u; // including index 0; keeps the largest code finite

float packMetallic(float metallic, uint index) {
    if (index == 0u) return metallic;
    return unpackHalf2x16(HALF_ONE + 1u + (min(index, MOST_DIELECTRICS - 1u) - 1u) * 256u
        + uint(clamp(metallic, 0.0, 1.0) * 255.0 + 0.5)).x;
}

float unpackMetallic(float code, out uint index) {
    index = 0u;
    if (code <= 1.0) return code;
    uint steps = (packHalf2x16(vec2(code, 0.0)) & 0xffffu) - HALF_ONE - 1u;
    index = 1u + steps / 256u;
    return float(steps % 256u) / 255.0;
}

#endif
