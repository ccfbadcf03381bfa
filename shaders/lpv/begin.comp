#version 460
#extension GL_GOOGLE_include_directive : require
// The injected light as the first wave.
#include "params.glsl"
#include "lpv/grid.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer LpvInjected { uint words[]; } lpvInjected;
// Red, green and blue of each cell, of two waves.
layout(std430) writeonly buffer LpvWaves { vec4 coefficients[]; } lpvWaves;
layout(std430) writeonly buffer LpvSums { vec4 coefficients[]; } lpvSums;

void main() {
    uint cell = gl_GlobalInvocationID.x;
    if (cell >= params.lpv_cells) return;
    for (uint channel = 0; channel < 3; channel++) {
        vec4 light;
        for (uint i = 0; i < 4; i++) {
            uint word = 2u * (12u * cell + 4u * channel + i);
            float high = float(int(lpvInjected.words[word + 1])), low = float(lpvInjected.words[word]);
            light[i] = (high * 4294967296.0 + low) / LIGHT_UNIT;
        }
        lpvWaves.coefficients[3 * cell + channel] = light;
        lpvSums.coefficients[3 * cell + channel] = vec4(0.0); // light counts where it arrives
    }
}
