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
const float FEW = 64.0; // paths of a distribution of which half is learned

float light(uint guide, uint x, uint y) {
    return float(guideSums.sums[65 * guide + 8 * y + x]);
}

void main() {
    uint guide = gl_GlobalInvocationID.x;
    if (64 * guide >= guideEnds.ends.length()) return;
    float sum = 0.0;
    for (uint i = 0; i < 64; i++) sum += light(guide, i % 8, i / 8);
    float paths = float(guideSums.sums[65 * guide + 64]);
    float learned = sum > 0.0 ? (1.0 - UNIFORM) * paths / (paths + FEW) : 0.0, end = 0.0;
    for (uint i = 0; i < 64; i++) {
        uint x = i % 8, y = i / 8;
        float near = light(guide, max(x, 1) - 1, y) + light(guide, min(x + 1, 7), y)
            + light(guide, x, (y + 1) % 8) + light(guide, x, (y + 7) % 8);
        float smoothed = 0.5 * light(guide, x, y) + 0.125 * near;
        end += mix(1.0 / 64.0, smoothed / max(sum, 1.0), learned);
        guideEnds.ends[64 * guide + i] = i == 63 ? 1.0 : min(end, 1.0);
    }
}
