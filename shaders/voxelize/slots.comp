#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the cells, and gives each a slot for every axis that its surfaces face along: a thread a bit, 32 a word of a brick.
#include "params.glsl"
#include "common/volume.glsl"
#include "common/voxels.glsl"
#include "common/bricks.glsl"

layout(local_size_x = 128) in;

layout(r32ui) uniform uimage3D voxelIndex;

shared uint faces[4][3]; // of a word: which of its cells face along x, y, z
shared uint first_slot[4];
shared uint first_cell[4];

void main() {
    uint now = voxelCounter.half_used, lane = gl_LocalInvocationIndex & 31u, part = gl_LocalInvocationIndex >> 5;
    for (uint start = gl_WorkGroupID.x * 4; start < voxelCounter.words; start += gl_NumWorkGroups.x * 4) {
        if (lane < 3) faces[part][lane] = 0;
        barrier();
        bool listed = start + part < voxelCounter.words;
        uint word = listed ? voxelWords.list[start + part] : 0;
        ivec3 cell = cellOfBit(word, lane);
        // Of bits beyond the cells none is set.
        bool set = listed && (voxelBricks.masks[brickWord(now, ivec3(0), 0) + word] >> lane & 1u) != 0;
        uint axes = set ? imageLoad(voxelIndex, cell).r & 7u : 0;
        for (uint axis = 0; axis < 3; axis++)
            if ((axes >> axis & 1u) != 0) atomicOr(faces[part][axis], 1u << lane);
        barrier();
        uvec3 all = uvec3(faces[part][0], faces[part][1], faces[part][2]), before = all & ((1u << lane) - 1u);
        uint occupied = all.x | all.y | all.z;
        if (lane == 0 && occupied != 0) {
            first_slot[part] = atomicAdd(voxelCounter.allocated, bitCount(all.x) + bitCount(all.y) + bitCount(all.z));
            first_cell[part] = atomicAdd(voxelCounter.cells[now], bitCount(occupied));
        }
        barrier();
        if (axes == 0) continue;
        uint packed = packCell(cell), i = first_cell[part] + bitCount(occupied & ((1u << lane) - 1u));
        if (i < roomForCells()) voxelCells.list[now * roomForCells() + i] = packed;
        else voxelCounter.signatures[now] = 0; // it does not name all
        uint first = first_slot[part] + bitCount(before.x) + bitCount(before.y) + bitCount(before.z), end = first + bitCount(axes);
        if (end > uint(params.voxel_capacity)) {
            imageStore(voxelIndex, cell, uvec4(CELL_FULL));
            continue;
        }
        for (uint axis = 0, slot = first; axis < 3; axis++)
            if ((axes >> axis & 1u) != 0) voxelSlots.words[slot++ * SLOT_WORDS + SLOT_CELL] = packed | (axis + 1) << 30;
        imageStore(voxelIndex, cell, uvec4(first << 3 | axes));
    }
}
