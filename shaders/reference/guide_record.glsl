#include "common/random.glsl"

// Sums of the light that arrives in each bin, relative to the geometric mean of the first round's.
layout(std430) buffer GuideSums {
    int logarithm; // sum of 4 log2 of the first round's values
    uint values;
    uint sums[]; // for each distribution, one for each bin, and the number of paths
} guideSums;

const float BRIGHTEST = 1024.0;

struct GuideVertex {
    uint guide;
    uint bin; // GUIDE_BINS: behind the side
    float share; // cosine / pdf
    vec3 sum; // radiance of the path before
    vec3 weight;
};

GuideVertex guideVertex(uint guide, Surface s, vec3 d, float density, vec3 sum, vec3 weight) {
    vec3 v = toSide(guide, d);
    uint bin = v.z > 0.0 ? guideBin(v) : GUIDE_BINS;
    return GuideVertex(guide, bin, max(dot(s.normal, d), 0.0) / density, sum, weight);
}

// Light in whole numbers: their sum does not depend on the order of threads. All paths together cannot
// overflow a bin. The unit may be large for that, so numbers are rounded by chance.
void guideRecord(GuideVertex v, vec3 sum) {
    float value = luminance((sum - v.sum) / max(v.weight, vec3(1e-20))) * v.share;
    if (v.bin == GUIDE_BINS || isinf(value)) return;
    if (pass.index == 0) {
        if (gl_LocalInvocationIndex != 0 || !(value > 0.0)) return;
        atomicAdd(guideSums.logarithm, int(round(4.0 * log2(value))));
        atomicAdd(guideSums.values, 1u);
        return;
    }
    uint first = v.guide * (GUIDE_BINS + 1);
    atomicAdd(guideSums.sums[first + GUIDE_BINS], 1u);
    if (!(value > 0.0)) return;
    float mean = exp2(float(guideSums.logarithm) / (4.0 * float(max(guideSums.values, 1u))));
    float paths = float(camera.size.x) * float(camera.size.y) * float(params.learning);
    float unit = max(1.0 / 16.0, paths * BRIGHTEST / 536870912.0);
    float units = min(value / mean, BRIGHTEST) / unit;
    uvec4 key = uvec4(gl_GlobalInvocationID.xy, pass.index, first + v.bin);
    float chance = float(hash4(key).x >> 8) / 16777216.0;
    atomicAdd(guideSums.sums[first + v.bin], uint(units + chance));
}
