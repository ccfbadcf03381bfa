// Denser cells in the middle: a logistic curve (thesis, Section 4.6.1), 0.5 + 0.5 tanh(s/2 (x - 1/2)) /
// tanh(s/4), written without the difference of tanh, which would cancel at the borders.
const bool WARPED = true;

vec3 warp(vec3 x) {
    float s = params.warp_steepness;
    vec3 folded = 0.5 - abs(x - 0.5);
    vec3 y = sinh(0.5 * s * folded) / (2.0 * sinh(0.25 * s) * cosh(0.5 * s * (0.5 - folded)));
    return mix(y, 1.0 - y, greaterThan(x, vec3(0.5)));
}

vec3 warpSlope(vec3 x) {
    float s = params.warp_steepness;
    vec3 t = tanh(0.5 * s * (x - 0.5));
    return 0.25 * s * (1.0 - t * t) / tanh(0.25 * s);
}

vec3 unwarp(vec3 y) {
    float s = params.warp_steepness, e = exp(0.5 * s);
    vec3 folded = 0.5 - abs(y - 0.5);
    vec3 x = log((1.0 + folded * (e - 1.0)) / (1.0 - folded * (1.0 - 1.0 / e))) / s;
    return mix(x, 1.0 - x, greaterThan(y, vec3(0.5)));
}

#include "volume/boxes.glsl"
