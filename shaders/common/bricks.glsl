// Which cells are occupied, a bit each: 64 in a brick of 4x4x4. Half a megabyte for 160^3, so that rays pass empty space in
// a cache. As the list of cells, this frame's in one half of the buffer and last frame's in the other.
#ifndef BRICKS_GLSL
#define BRICKS_GLSL
#include "common/volume.glsl"

layout(std430) buffer VoxelBricks { uint masks[]; } voxelBricks;
layout(std430) buffer VoxelWords { uint list[]; } voxelWords; // words that are set, from the start of the half

// Bricks along an edge of a cascade; the last ones may reach beyond its cells.
uint brickEdge() {
    return (uint(params.voxel_dim) + 3u) / 4u;
}

// The cell, as textures hold it, of a bit of a word that is counted from the start of a half.
ivec3 cellOfBit(uint word, uint bit) {
    uint edge = brickEdge(), brick = word / 2, z = brick / (edge * edge);
    ivec3 cell = 4 * ivec3(brick % edge, brick / edge % edge, z % edge) + ivec3(bit & 3u, bit >> 2 & 3u, (word & 1u) << 1 | bit >> 4);
    return storedCell(cell, int(z / edge));
}

// The first of a brick's two words, of the cells with z 0 and 1, from the start of a half; and in the buffer.
uint brickNumber(ivec3 cell, int cascade) {
    uint edge = brickEdge();
    uvec3 brick = uvec3(cell) >> 2;
    return 2 * (brick.x + edge * (brick.y + edge * (brick.z + edge * uint(cascade))));
}

uint brickWord(uint half_used, ivec3 cell, int cascade) {
    return half_used * (voxelBricks.masks.length() / 2) + brickNumber(cell, cascade);
}

// A cell's word in its brick, 0 or 1, and its bit there.
uint wordOfCell(ivec3 cell) {
    return uint(cell.z) >> 1 & 1u;
}

uint bitOfCell(ivec3 cell) {
    return 1u << (uint(cell.x) & 3u | (uint(cell.y) & 3u) << 2 | (uint(cell.z) & 1u) << 4);
}

#endif
