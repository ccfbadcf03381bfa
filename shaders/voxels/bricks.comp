#version 460
#extension GL_GOOGLE_include_directive : require
// Tests the cells of each listed brick, one group per brick and one thread per cell.
#include "params.glsl"
#include "voxels/pieces.glsl"

layout(local_size_x = 64) in;

void main() {
    uint count = min(voxelCounter.touched, voxelTouched.list.length());
    ivec3 lane = ivec3(gl_LocalInvocationIndex & 3u, gl_LocalInvocationIndex >> 2 & 3u,
        gl_LocalInvocationIndex >> 4);
    for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
        uvec2 entry = voxelTouched.list[i];
        VoxelPiece p = voxelPieces.list[entry.x];
        VolumeMap map = volume.maps[p.cascade];
        // In curved cells the exact range costs as much as the cell test. Only x is bounded there, so that no
        // cell is stored twice across the seam.
        CellRange r = CellRange(ivec3(int(p.columns & 0xffffu) - 1024, 0, 0),
            ivec3(int(p.columns >> 16) - 1024, params.voxel_dim - 1, params.voxel_dim - 1));
        if (isFlat(map)) r = rangeOf(map, p);
        ivec3 cell = ivec3(int(entry.y & 4095u) - 1024, entry.y >> 12 & 1023u, entry.y >> 22) * BRICK + lane;
        bool within = all(greaterThanEqual(cell, r.from)) && all(lessThanEqual(cell, r.to));
        if (within && touches(map, p, cell, ivec3(1), 0.0)) storeCell(map, p, cell);
    }
}
