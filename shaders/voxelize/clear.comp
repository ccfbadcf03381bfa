#version 460
#extension GL_GOOGLE_include_directive : require
// Clears what this frame fills, and last frame's sums.
#include "params.glsl"
#include "voxelize/clearing.glsl"
#include "common/bricks.glsl"

layout(local_size_x = 128) in;

uniform writeonly image3D voxelColor;
uniform writeonly image3D voxelNormal;

void clearViews(ivec3 cell) {
    imageStore(voxelColor, cell, vec4(0));
    imageStore(voxelNormal, cell, vec4(0));
}

void main() {
    uint now = voxelCounter.half_used, cells = voxelCounter.clear_cells, last_cells = cellsToClear(1 - now);
    uint slots = min(voxelCounter.clear_slots, voxelSlots.words.length() / SLOT_WORDS);
    uint first = gl_GlobalInvocationID.x, stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint i = first; i < max(cells, last_cells); i += stride) {
        if (i < cells) {
            ivec3 cell = cellToClear(now, i);
            ivec3 own = ivec3(cell.xy, cell.z % params.voxel_dim);
            uint block = blockNumber(now, own, cascadeOf(cell));
            voxelBricks.words[wordsOfHalf(now) + wordNumber(own, cascadeOf(cell))] = uvec4(0);
            voxelBlocks.masks[block] = voxelBlocks.masks[block + 1] = 0;
        }
        if (i < last_cells) clearViews(cellToClear(1 - now, i));
    }
    // Word by word: threads beside each other write beside each other.
    for (uint word = first; word < slots * SLOT_WORDS; word += stride) voxelSlots.words[word] = 0;
}
