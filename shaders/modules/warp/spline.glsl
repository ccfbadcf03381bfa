// Denser cells in the middle: a cubic with slope warp_alpha at the borders (thesis, Section 4.6.1). At 1 the
// grid is uniform.
#define WARPED (params.warp_alpha < 1.0)

vec3 warp(vec3 x) {
    float a = params.warp_alpha;
    return x * (a + x * (3.0 - 3.0 * a + x * (2.0 * a - 2.0)));
}

vec3 warpSlope(vec3 x) {
    float a = params.warp_alpha;
    return a + x * (6.0 - 6.0 * a + x * (6.0 * a - 6.0));
}

// Newton's method on the convex lower half from its upper end: monotonic, no overshoot.
vec3 unwarp(vec3 y) {
    if (!WARPED) return y;
    vec3 folded = 0.5 - abs(y - 0.5);
    vec3 x = vec3(0.5);
    for (int i = 0; i < 10; i++) x -= (warp(x) - folded) / warpSlope(x);
    return mix(x, 1.0 - x, greaterThan(y, vec3(0.5)));
}

#include "volume/boxes.glsl"
