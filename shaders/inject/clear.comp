#version 460
#extension GL_GOOGLE_include_directive : require
// Takes what last frame left in its voxels out of them, once nothing needs it any more: of the settings of now, cells that were set;
// else all. Clearing the whole volume would cost more than voxelizing. Bricks and `volume` are last frame's.
#include "params.glsl"
#include "common/bricks.glsl"

layout(local_size_x = 128) in;

uniform writeonly image3D injected;

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= voxelBricks.words.length()) return;
    uint cells = volume.signature == params.voxel_signature ? occupiedCells(voxelBricks.words[number]) : ~0u;
    for (; cells != 0; cells &= cells - 1) {
        ivec3 cell = cellOfBit(number, findLSB(cells));
        for (int face = 0; face < params.radiance_faces; face++)
            imageStore(injected, ivec3(cell.x + face * params.voxel_dim, cell.yz), vec4(0));
    }
}
