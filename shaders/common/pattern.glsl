// Points and patterns that are the same in every run.
#ifndef PATTERN_GLSL
#define PATTERN_GLSL

// Point i of the R2 sequence (Roberts 2018), which fills the unit square evenly; and the same moved by a shift.
vec2 r2(uint i, vec2 shift) {
    return fract(shift + float(i) * vec2(0.7548776662, 0.5698402910));
}

vec2 r2(uint i) {
    return r2(i, vec2(0.5));
}

// Number of a pixel in its block of 8x8, 0 to 63: numbers that follow each other lie far apart.
uint patternIndex(uvec2 pixel) {
    uvec2 at = pixel & 7u;
    uint turn = (at.x ^ at.y) & 1u | (at.y & 1u) << 1 | ((at.x ^ at.y) & 2u) << 1 | (at.y & 2u) << 2 | ((at.x ^ at.y) & 4u) << 2 | (at.y & 4u) << 3;
    return bitfieldReverse(turn) >> 26;
}

#endif
