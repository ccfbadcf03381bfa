// Random numbers of a path: two Owen-scrambled Sobol points in two dimensions for each draw, in an order of
// their own, so that draws are uncorrelated (Burley 2020, "Practical Hash-Based Owen Scrambling"). Even and
// odd samples are independent sequences, because the difference of their means tells the noise.
#ifndef REFERENCE_SEQUENCE_GLSL
#define REFERENCE_SEQUENCE_GLSL
#include "common/random.glsl"

struct Sequence {
    uvec4 key; // pixel, half, draw, seed
    uint index; // within the half
};

// stream: draws of different streams are independent.
Sequence sequenceOf(ivec2 pixel, uint sample_index, uint stream) {
    uint place = uint(pixel.x) | uint(pixel.y) << 16;
    return Sequence(uvec4(place, sample_index & 1u, stream << 16, uint(params.seed)), sample_index >> 1);
}

// Flips each bit by a hash of the bits below it (Laine and Karras 2011; constants by Vegdahl).
uvec4 flipBits(uvec4 v, uvec4 seed) {
    v ^= v * 0x3d20adeau;
    v += seed;
    v *= (seed >> 16) | 1u;
    v ^= v * 0x05526c56u;
    v ^= v * 0x53a22864u;
    return v;
}

// The second dimension: reversed Pascal's triangle modulo 2, which is five shears.
uint sobolSecond(uint i) {
    i ^= (i & 0xffff0000u) >> 16;
    i ^= (i & 0xff00ff00u) >> 8;
    i ^= (i & 0xf0f0f0f0u) >> 4;
    i ^= (i & 0xccccccccu) >> 2;
    i ^= (i & 0xaaaaaaaau) >> 1;
    return bitfieldReverse(i);
}

// Four numbers in [0, 1), 24 bits each.
vec4 next4(inout Sequence s) {
    s.key.z++;
    uvec4 h = hash4(s.key);
    // Dimensions with their bits reversed: the lowest bit is the first one.
    uvec4 i = bitfieldReverse(flipBits(uvec4(bitfieldReverse(s.index)), h.xxyy));
    uvec4 reversed = uvec4(i.x, bitfieldReverse(sobolSecond(i.x)), i.z, bitfieldReverse(sobolSecond(i.z)));
    uvec4 points = bitfieldReverse(flipBits(reversed, hash4(h)));
    return vec4(points >> 8u) * (1.0 / 16777216.0);
}

#endif
