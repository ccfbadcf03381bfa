#version 460
#extension GL_GOOGLE_include_directive : require
// Shares of the bins of one distribution: learned sums, smoothed, with the uniform ones where few were seen.
#include "params.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer GuideSums {
    int logarithm;
    uint values;
    uint sums[];
} guideSums;
layout(std430) writeonly buffer GuideEnds { float ends[]; } guideEnds;

const float UNIFORM = 0.1; // share that is never learned
const float UNSEEN = 32.0 * 16.0; // sum of a distribution below which most of it is uniform

void main() {
    uint first = gl_GlobalInvocationID.x * 64;
    if (first >= guideEnds.ends.length()) return;
    float sum = 0.0;
    for (uint i = 0; i < 64; i++) sum += float(guideSums.sums[first + i]);
    float learned = (1.0 - UNIFORM) * sum / (sum + UNSEEN), end = 0.0;
    for (uint i = 0; i < 64; i++) {
        uint x = i % 8, y = i / 8;
        float near = float(guideSums.sums[first + 8 * y + max(x, 1) - 1])
            + float(guideSums.sums[first + 8 * y + min(x + 1, 7)])
            + float(guideSums.sums[first + 8 * ((y + 1) % 8) + x])
            + float(guideSums.sums[first + 8 * ((y + 7) % 8) + x]);
        float smoothed = 0.5 * float(guideSums.sums[first + i]) + 0.125 * near;
        end += sum > 0.0 ? mix(1.0 / 64.0, smoothed / sum, learned) : 1.0 / 64.0;
        guideEnds.ends[first + i] = i == 63 ? 1.0 : min(end, 1.0);
    }
}
