// Sectors of a slice: the half plane of directions around a pixel's view ray, weighted by the cosine to
// the normal and by the solid angle. All sectors have the same weight, so that a bit count is an integral
// (in Therrien et al. 2023 sectors have equal angles, and each sample has its cosine).
#ifndef SSGI_SLICE_GLSL
#define SSGI_SLICE_GLSL
#include "common/math.glsl"

const float SECTORS = 32.0;

struct Slice {
    vec3 to_viewer;
    vec3 tangent; // unit, perpendicular to to_viewer
    float tilt; // signed angle from to_viewer to the normal's projection
    float weight; // the integral of the slice: share of the hemisphere's light, 1 on the mean of slices
    float first, total; // of the running integral
};

// Integral of cos(t - tilt) |sin t| from 0 to `angle`, which is signed.
float runningWeight(float angle, float tilt) {
    float antiderivative = 0.25 * (cos(tilt) - cos(2.0 * angle - tilt)) + 0.5 * angle * sin(tilt);
    return angle < 0.0 ? -antiderivative : antiderivative;
}

// along: direction in the plane of the slice, not that of to_viewer.
Slice sliceOf(vec3 normal, vec3 to_viewer, vec3 along) {
    Slice s;
    s.to_viewer = to_viewer;
    s.tangent = normalize(along - to_viewer * dot(along, to_viewer));
    vec2 flat_normal = vec2(dot(normal, s.tangent), dot(normal, to_viewer));
    s.tilt = atan(flat_normal.x, flat_normal.y);
    s.first = runningWeight(s.tilt - 0.5 * PI, s.tilt);
    s.total = runningWeight(s.tilt + 0.5 * PI, s.tilt) - s.first;
    s.weight = length(flat_normal) * s.total;
    return s;
}

// Place of an angle among the sectors, 0 to SECTORS.
float sectorOf(Slice s, float angle) {
    float inside = clamp(angle, s.tilt - 0.5 * PI, s.tilt + 0.5 * PI);
    return SECTORS * clamp((runningWeight(inside, s.tilt) - s.first) / s.total, 0.0, 1.0);
}

// Direction at a place among the sectors, by bisection.
vec3 directionAt(Slice s, float sector) {
    float low = s.tilt - 0.5 * PI, high = s.tilt + 0.5 * PI;
    for (int i = 0; i < 12; i++) {
        float middle = 0.5 * (low + high);
        if (sectorOf(s, middle) < sector) low = middle;
        else high = middle;
    }
    float angle = 0.5 * (low + high);
    return cos(angle) * s.to_viewer + sin(angle) * s.tangent;
}

// Angle of the direction towards a point, negative on the other side of the view ray.
float angleOf(Slice s, vec3 off) {
    return atan(dot(off, s.tangent), dot(off, s.to_viewer));
}

// Bits of the sectors from one place to another. shift in [0, 1) rounds: on the mean over shifts bits are
// exact.
uint sectorsBetween(float from, float to, float shift) {
    int low = int(floor(from + shift)), high = min(int(floor(to + shift)), 32);
    if (high <= low) return 0u;
    uint up_to = high >= 32 ? ~0u : (1u << high) - 1u;
    return up_to & ~(low >= 32 ? ~0u : (1u << low) - 1u);
}

// Number of the n-th set bit.
int nthBit(uint bits, int n) {
    for (int i = 0; i < n; i++) bits &= bits - 1u;
    return findLSB(bits);
}

#endif
