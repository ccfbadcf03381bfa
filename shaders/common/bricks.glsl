// Which cells are occupied, a bit each: 64 in a brick of 4x4x4. Half a megabyte for 160^3, so that rays pass empty space in
// a cache. As the list of cells, this frame's in one half of the buffer and last frame's in the other.
#ifndef BRICKS_GLSL
#define BRICKS_GLSL

layout(std430) buffer VoxelBricks { uint masks[]; } voxelBricks;

// The first of a brick's two words, of the cells with z 0 and 1. `stored`: as textures hold it.
uint brickWord(uint half_used, ivec3 stored) {
    uint edge = uint(params.voxel_dim) / 4u;
    uvec3 brick = uvec3(stored) >> 2;
    return half_used * (voxelBricks.masks.length() / 2) + 2 * (brick.x + edge * (brick.y + edge * brick.z));
}

// A cell's word in its brick, 0 or 1, and its bit there.
uint wordOfCell(ivec3 cell) {
    return uint(cell.z) >> 1 & 1u;
}

uint bitOfCell(ivec3 cell) {
    return 1u << (uint(cell.x) & 3u | (uint(cell.y) & 3u) << 2 | (uint(cell.z) & 1u) << 4);
}

#endif
