// Anderson acceleration of the bounces with one step of memory (Walker and Ni 2011, "Anderson acceleration
// for fixed-point iterations"). While nothing changes, a short round maps the light x of all sides to g(x),
// always in the same way, because directions repeat. With the residual f = g(x) - x, the next round starts
// from g - t (g - g'), where t minimises |f - t (f - f')| and ' marks the round before.
#ifndef BOUNCE_ACCELERATION_GLSL
#define BOUNCE_ACCELERATION_GLSL
#include "surfels/surfels.glsl"
#include "history/rounds.glsl"

// Sums over the sides of a round. Integers, so that their order does not matter.
struct RoundSums {
    uint largest[3]; // |f|, as bits of a float
    uint products[6][2]; // by channel f (f - f'), then (f - f')^2; 64 bits, low word first
};

const float SUM_UNIT = 262144.0; // 64 sides of the largest terms fit into 31 bits
const float LARGEST_TERM = 8.0; // relative to the largest residual of the round before

// Half floats: the residual f, then g - g'.
struct SideChange {
    uint halves[3];
};

const SideChange NO_CHANGE = SideChange(uint[3](0u, 0u, 0u));

SideChange packChange(vec3 residual, vec3 advance) {
    vec3 f = clamp(residual, -65504.0, 65504.0), g = clamp(advance, -65504.0, 65504.0);
    return SideChange(uint[3](packHalf2x16(f.rg), packHalf2x16(vec2(f.b, g.r)), packHalf2x16(g.gb)));
}

vec3 residualOf(SideChange change) {
    return vec3(unpackHalf2x16(change.halves[0]), unpackHalf2x16(change.halves[1]).x);
}

vec3 advanceOf(SideChange change) {
    return vec3(unpackHalf2x16(change.halves[1]).y, unpackHalf2x16(change.halves[2]));
}

float sumOf(uint words[2]) {
    uint low = words[0], high = words[1];
    bool negative = int(high) < 0;
    if (negative) {
        low = ~low + 1u;
        high = ~high + uint(low == 0u);
    }
    float sum = float(high) * 4294967296.0 + float(low);
    return negative ? -sum : sum;
}

// t of the next start, by channel. Its bounds keep noise from throwing light far off.
vec3 stepFrom(RoundSums sums) {
    vec3 t = vec3(0.0);
    for (int c = 0; c < 3; c++) {
        float squared = sumOf(sums.products[3 + c]);
        if (squared > 0.0) t[c] = clamp(sumOf(sums.products[c]) / squared, -60.0, 0.9);
    }
    return t;
}

#endif
