#version 460
#extension GL_GOOGLE_include_directive : require
// Numbers the bricks that have a surface, in block order, one chunk of blocks per group. Also writes the
// dispatch arguments of passes over bricks and fragments.
#include "params.glsl"
#include "voxels/bricks.glsl"
#define SUMS_CHUNKS
#include "voxels/chunks.glsl"

const uint CHUNK_BLOCKS = CHUNK_THREADS * 4;

uint bricksOf(uint block) {
    return block < voxelBlocks.list.length() ?
        bitCount(voxelBlocks.list[block].x) + bitCount(voxelBlocks.list[block].y) : 0;
}

// Numbers a block's bricks, and drops those beyond the capacity. Another group may count a block before or
// after its bricks are dropped: either result leaves it no room.
void assignIndices(uint block, uint first) {
    uint next = first, room = voxelBrickIds.bricks.length();
    for (uint word = 0; word < 2; word++) {
        for (uint left = voxelBlocks.list[block][word]; left != 0; left &= left - 1) {
            uint local = 32 * word + findLSB(left);
            if (next < room) voxelBrickIds.bricks[next++] = 64 * block + local;
            else voxelBlocks.list[block][word] &= ~bitOf(local);
        }
    }
    voxelBlocks.list[block].z = first;
}

void main() {
    uint chunk = gl_WorkGroupID.x * CHUNK_BLOCKS, thread = gl_LocalInvocationIndex, before = 0;
    // Each group counts all bricks before its chunk. There are few blocks, and this saves a pass.
    for (uint block = thread; block < chunk; block += CHUNK_THREADS) before += bricksOf(block);
    uint start = groupSum(before), total = 0;
    for (uint i = 0; i < 4; i++) total += bricksOf(chunk + 4 * thread + i);
    uint sum = inclusiveSum(total), first = start + sum - total;
    for (uint i = 0; i < 4; i++) {
        uint block = chunk + 4 * thread + i, count = bricksOf(block);
        if (count > 0) assignIndices(block, first);
        first += count;
    }
    if (gl_WorkGroupID.x < gl_NumWorkGroups.x - 1 || thread < CHUNK_THREADS - 1) return;
    uint bricks = min(first, voxelBrickIds.bricks.length()),
        fragments = min(voxelCounter.fragments, voxelFragments.list.length());
    voxelCounter.bricks = bricks;
    voxelCounter.fragment_groups = uvec3(min((fragments + 127) / 128, 32768u), 1, 1);
    voxelCounter.chunk_groups = uvec3((2 * bricks + CHUNK_WORDS - 1) / CHUNK_WORDS, 1, 1);
    voxelCounter.word_groups = uvec3(min((2 * bricks + 3) / 4, 65535u), 1, 1);
}
