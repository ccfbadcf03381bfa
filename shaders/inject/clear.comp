#version 460
#extension GL_GOOGLE_include_directive : require
// Clears last frame's radiance once no pass reads it any more: only the occupied cells, or all cells if the
// settings have changed. Clearing the whole volume would cost more than voxelizing. Bricks and `volume` are
// last frame's.
#include "params.glsl"
#include "voxels/bricks.glsl"

layout(local_size_x = 128) in;

uniform writeonly image3D injected;

void main() {
    uint brick = gl_GlobalInvocationID.x;
    if (brick / 64 >= voxelBlocks.list.length()) return;
    uvec4 block = voxelBlocks.list[brick / 64];
    bool all = volume.signature != params.voxel_signature;
    if (!all && !isStored(block, brick % 64)) return;
    for (uint word = 0; word < 2; word++) {
        uint cells = all ? ~0u : occupiedCells(voxelBricks.words[2 * brickIndex(block, brick % 64) + word]);
        for (; cells != 0; cells &= cells - 1) {
            int cascade;
            ivec3 cell = cellAt(brick, 32 * word + findLSB(cells), cascade);
            if (!inGrid(cell)) continue;
            cell = storedCell(cell, cascade);
            for (int face = 0; face < params.radiance_faces; face++)
                imageStore(injected, ivec3(cell.x + face * params.voxel_dim, cell.yz), vec4(0));
        }
    }
}
