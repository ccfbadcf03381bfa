// Deterministic point sequences and pixel patterns.
#ifndef PATTERN_GLSL
#define PATTERN_GLSL

// Point i of the R2 sequence (Roberts 2018), which fills the unit square evenly, with a shift.
vec2 r2(uint i, vec2 shift) {
    return fract(shift + float(i) * vec2(0.7548776662, 0.5698402910));
}

vec2 r2(uint i) {
    return r2(i, vec2(0.5));
}

// Index of a pixel in its 8x8 block, 0 to 63. Consecutive indices are far apart.
uint patternIndex(uvec2 pixel) {
    uvec2 at = pixel & 7u;
    uint turn = (at.x ^ at.y) & 1u | (at.y & 1u) << 1 | ((at.x ^ at.y) & 2u) << 1 | (at.y & 2u) << 2
        | ((at.x ^ at.y) & 4u) << 2 | (at.y & 4u) << 3;
    return bitfieldReverse(turn) >> 26;
}

#endif
