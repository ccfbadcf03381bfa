#version 460
#extension GL_GOOGLE_include_directive : require
// Assigns surfels to cells: one for each axis that the cell's surfaces face. One thread per cell, 32 threads
// per brick word.
#include "params.glsl"
#include "voxels/bricks.glsl"
#include "voxels/chunks.glsl"

layout(local_size_x = 128) in;

// Writes the cell and axis of each surfel of a cell.
void nameSurfels(uint index, uvec4 word, uint bit) {
    ivec3 cell = storedCellAt(voxelBrickIds.bricks[index / 2], 32 * (index & 1u) + bit);
    uint packed = packCell(cell), found = foundIn(word, 1u << bit);
    for (uint axis = 0; axis < 3; axis++) {
        if ((found >> axis & 1u) == 0) continue;
        uint base = surfelOf(found, axis) * SURFEL_SUM_WORDS;
        surfelSums.words[base + SURFEL_CELL] = packed | (axis + 1) << 30;
    }
}

void main() {
    uint lane = gl_LocalInvocationIndex & 31u, part = gl_LocalInvocationIndex >> 5;
    uint words = 2 * voxelCounter.bricks, stride = gl_NumWorkGroups.x * 4;
    for (uint start = gl_WorkGroupID.x * 4; start < words; start += stride) {
        uint index = start + part;
        bool valid = index < words;
        uvec4 word = valid ? voxelBricks.words[index] : uvec4(0);
        barrier();
        word.w += voxelStarts.surfels[index / CHUNK_WORDS];
        if (lane == 0 && valid) voxelBricks.words[index].w = word.w;
        if ((occupiedCells(word) >> lane & 1u) != 0) nameSurfels(index, word, lane);
    }
}
