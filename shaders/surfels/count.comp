#version 460
#extension GL_GOOGLE_include_directive : require
// Prefix sum of the surfel counts of brick words, within each chunk.
#include "params.glsl"
#include "voxels/bricks.glsl"
#define SUMS_CHUNKS
#include "voxels/chunks.glsl"

void main() {
    uint thread = gl_LocalInvocationIndex, first = gl_WorkGroupID.x * CHUNK_WORDS + thread * THREAD_WORDS;
    uint words = 2 * voxelCounter.bricks, before[THREAD_WORDS], sum = 0;
    for (uint i = 0; i < THREAD_WORDS; i++) {
        uvec4 word = first + i < words ? voxelBricks.words[first + i] : uvec4(0);
        before[i] = sum;
        sum += bitCount(word.x) + bitCount(word.y) + bitCount(word.z);
    }
    uint count = sum;
    sum = inclusiveSum(count);
    for (uint i = 0; i < THREAD_WORDS; i++)
        if (first + i < words) voxelBricks.words[first + i].w = sum - count + before[i];
    if (thread == CHUNK_THREADS - 1) voxelChunks.surfels[gl_WorkGroupID.x] = sum;
}
