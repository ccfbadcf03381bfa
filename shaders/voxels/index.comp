#version 460
#extension GL_GOOGLE_include_directive : require
// Writes surfel lookups to a texture of all cells, for views and inspection. Cells with surfels that found no
// room have all bits set. Bricks that found no room are empty.
#include "params.glsl"
#include "voxels/bricks.glsl"

layout(local_size_x = 128) in;

layout(r32ui) uniform writeonly uimage3D voxelIndex;

// Whether an alpha mask has cut out all surfaces of a cell.
bool isEmpty(uint found) {
    for (uint i = 0; i < surfelCount(found) * SIDES; i++)
        if (surfelSums.words[sideBase(firstSurfel(found) + i / SIDES, i % SIDES) + 3] != 0) return false;
    return found != 0;
}

void main() {
    uint lane = gl_LocalInvocationIndex & 31u;
    for (uint index = gl_GlobalInvocationID.x >> 5; index < 2 * voxelCounter.bricks;
            index += gl_NumWorkGroups.x * 4) {
        uint bit = 1u << lane;
        uvec4 word = voxelBricks.words[index];
        if ((occupiedCells(word) & bit) == 0) continue;
        uint found = foundIn(word, bit);
        if (isEmpty(found)) continue;
        imageStore(voxelIndex, storedCellAt(voxelBrickIds.bricks[index / 2], 32 * (index & 1u) + lane),
            uvec4(found == 0 ? ~0u : found));
    }
}
