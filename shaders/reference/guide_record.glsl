// Sums of the light that arrives in each bin.
layout(std430) buffer GuideSums {
    int logarithm; // sum of 16 log2 of the first round's values
    uint values;
    uint sums[]; // 1/16 of the first round's mean; for each distribution one for each bin
} guideSums;

struct GuideVertex {
    uint bin;
    float share; // cosine / pdf
    vec3 sum; // radiance of the path before
    vec3 weight;
};

GuideVertex guideVertex(uint guide, Surface s, vec3 d, float density, vec3 sum, vec3 weight) {
    vec3 v = toSide(guide, d);
    uint bin = v.z > 0.0 ? guide * GUIDE_BINS + guideBin(v) : 0xffffffffu;
    return GuideVertex(bin, max(dot(s.normal, d), 0.0) / density, sum, weight);
}

// Light in whole numbers: their sum does not depend on the order of threads.
void guideRecord(GuideVertex v, vec3 sum) {
    vec3 weight = max(v.weight, vec3(1e-20));
    float value = luminance((sum - v.sum) / weight) * v.share;
    if (v.bin == 0xffffffffu || !(value > 0.0)) return;
    if (pass.index == 0) {
        if (gl_LocalInvocationIndex != 0) return;
        atomicAdd(guideSums.logarithm, int(round(16.0 * log2(value))));
        atomicAdd(guideSums.values, 1u);
        return;
    }
    float mean = exp2(float(guideSums.logarithm) / (16.0 * float(max(guideSums.values, 1u))));
    atomicAdd(guideSums.sums[v.bin], uint(round(16.0 * clamp(value / mean, 0.0, 8191.0))));
}
