#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the cells, and gives each a slot for every axis that its surfaces face along: a thread a bit, 32 a word of a brick.
#include "params.glsl"
#include "common/bricks.glsl"

layout(local_size_x = 128) in;

shared uint first_slot[4];
shared uint first_cell[4];

void main() {
    uint now = voxelCounter.half_used, lane = gl_LocalInvocationIndex & 31u, part = gl_LocalInvocationIndex >> 5;
    for (uint start = gl_WorkGroupID.x * 4; start < voxelCounter.words; start += gl_NumWorkGroups.x * 4) {
        bool listed = start + part < voxelCounter.words;
        uint number = listed ? voxelWords.list[start + part] : 0;
        uvec4 word = listed ? voxelBricks.words[wordsOfHalf(now) + number] : uvec4(0);
        uint occupied = occupiedCells(word), bit = 1u << lane;
        barrier();
        if (lane == 0 && listed) {
            first_slot[part] = atomicAdd(voxelCounter.allocated, bitCount(word.x) + bitCount(word.y) + bitCount(word.z));
            first_cell[part] = atomicAdd(voxelCounter.cells[now], bitCount(occupied));
            voxelBricks.words[wordsOfHalf(now) + number].w = first_slot[part];
        }
        barrier();
        if ((occupied & bit) == 0) continue;
        uint packed = packCell(cellOfBit(number, lane)), i = first_cell[part] + bitCount(occupied & (bit - 1u));
        if (i < roomForCells()) voxelCells.list[now * roomForCells() + i] = packed;
        else voxelCounter.signatures[now] = 0; // it does not name all
        uint found = foundIn(uvec4(word.xyz, first_slot[part]), bit);
        for (uint axis = 0; axis < 3; axis++)
            if ((found >> axis & 1u) != 0) voxelSlots.words[slotOf(found, axis) * SLOT_WORDS + SLOT_CELL] = packed | (axis + 1) << 30;
    }
}
