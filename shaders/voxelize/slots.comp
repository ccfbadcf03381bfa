#version 460
#extension GL_GOOGLE_include_directive : require
// Gives each cell a slot for every axis that its surfaces face along.
#include "params.glsl"
#include "common/volume.glsl"
#include "common/voxels.glsl"
#include "common/bricks.glsl"

layout(local_size_x = 128) in;

layout(r32ui) uniform uimage3D voxelIndex;

void main() {
    uint i = gl_GlobalInvocationID.x, now = voxelCounter.half_used;
    if (i >= cellsListed(now)) return;
    uint packed = voxelCells.list[now * roomForCells() + i];
    ivec3 cell = unpackCell(packed);
    uint axes = imageLoad(voxelIndex, cell).r & 7u, many = bitCount(axes);
    uint first = atomicAdd(voxelCounter.allocated, many), end = first + many;
    if (end > uint(params.voxel_capacity)) {
        imageStore(voxelIndex, cell, uvec4(CELL_FULL));
        return;
    }
    atomicMax(voxelCounter.count, end);
    atomicMax(voxelCounter.list_groups.x, min((end + 127) / 128, 65535u));
    atomicMax(voxelCounter.side_groups.x, min((end * SIDES + 127) / 128, 65535u));
    for (uint axis = 0, slot = first; axis < 3; axis++)
        if ((axes >> axis & 1u) != 0) voxelSlots.words[slot++ * SLOT_WORDS + SLOT_CELL] = packed | (axis + 1) << 30;
    imageStore(voxelIndex, cell, uvec4(first << 3 | axes));
    atomicOr(voxelBricks.masks[brickWord(now, cell) + wordOfCell(cell)], bitOfCell(cell));
}
