#version 460
#extension GL_GOOGLE_include_directive : require
// How many slots the words of bricks before each word have, of its chunk.
#include "params.glsl"
#include "common/bricks.glsl"
#include "voxelize/chunks.glsl"

layout(local_size_x = CHUNK_THREADS) in;

shared uint sums[CHUNK_THREADS];

void main() {
    uint thread = gl_LocalInvocationIndex, first = gl_WorkGroupID.x * CHUNK_WORDS + thread * THREAD_WORDS;
    uint before[THREAD_WORDS], sum = 0;
    for (uint i = 0; i < THREAD_WORDS; i++) {
        uvec4 word = first + i < voxelBricks.words.length() ? voxelBricks.words[first + i] : uvec4(0);
        before[i] = sum;
        sum += bitCount(word.x) + bitCount(word.y) + bitCount(word.z);
    }
    uint own = sum;
    for (uint distance = 1; distance < CHUNK_THREADS; distance *= 2) {
        sums[thread] = sum;
        barrier();
        if (thread >= distance) sum += sums[thread - distance];
        barrier();
    }
    if (own > 0)
        for (uint i = 0; i < THREAD_WORDS; i++)
            if (first + i < voxelBricks.words.length()) voxelBricks.words[first + i].w = sum - own + before[i];
    if (thread == CHUNK_THREADS - 1) voxelChunks.slots[gl_WorkGroupID.x] = sum;
}
