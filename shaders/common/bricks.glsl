// Where surfaces are: cells in bricks of 4x4x4, bricks in blocks of 4x4x4. A word stands for half a brick, 32 cells: a bit each for
// facing along x, y and z, and the first of their slots. A block has a bit for each brick that holds any, so that rays pass empty
// space in a cache: eight bytes for 16^3 cells.
#ifndef BRICKS_GLSL
#define BRICKS_GLSL
#include "common/volume.glsl"
#include "common/voxels.glsl"

layout(std430) buffer VoxelBricks { uvec4 words[]; } voxelBricks;
layout(std430) buffer VoxelBlocks { uint masks[]; } voxelBlocks;
layout(std430) buffer VoxelWords { uint list[]; } voxelWords; // words that are set

// Bricks or blocks along an edge of a cascade, of so many cells; the last ones may reach beyond them.
uint gridEdge(uint cells) {
    return (uint(params.voxel_dim) + cells - 1u) / cells;
}

// The first of a brick's two words or of a block's two masks.
uint gridNumber(uvec3 at, uint edge, int cascade) {
    return 2 * (at.x + edge * (at.y + edge * (at.z + edge * uint(cascade))));
}

// A cell's word in its brick, 0 or 1, and its bit there; a brick's in its block likewise.
uint wordOfCell(ivec3 cell) {
    return uint(cell.z) >> 1 & 1u;
}

uint bitOfCell(ivec3 cell) {
    return 1u << (uint(cell.x) & 3u | (uint(cell.y) & 3u) << 2 | (uint(cell.z) & 1u) << 4);
}

uint wordNumber(ivec3 cell, int cascade) {
    return gridNumber(uvec3(cell) >> 2, gridEdge(4), cascade) + wordOfCell(cell);
}

// The first mask of a cell's block.
uint blockNumber(ivec3 cell, int cascade) {
    return gridNumber(uvec3(cell) >> 4, gridEdge(16), cascade);
}

// The cell, as textures hold it, of a bit of a word.
ivec3 cellOfBit(uint word, uint bit) {
    uint edge = gridEdge(4), brick = word / 2, z = brick / (edge * edge);
    ivec3 cell = 4 * ivec3(brick % edge, brick / edge % edge, z % edge) + ivec3(bit & 3u, bit >> 2 & 3u, (word & 1u) << 1 | bit >> 4);
    return storedCell(cell, int(z / edge));
}

uint occupiedCells(uvec4 word) {
    return word.x | word.y | word.z;
}

// What a word says of a cell: along which axes its surfaces face, three bits, and above them the first of as many slots. 0: it has none,
// or the list of slots had no room left.
uint foundIn(uvec4 word, uint bit) {
    uint axes = uint((word.x & bit) != 0) | uint((word.y & bit) != 0) << 1 | uint((word.z & bit) != 0) << 2, before = bit - 1u;
    uint first = word.w + bitCount(word.x & before) + bitCount(word.y & before) + bitCount(word.z & before);
    return first + bitCount(axes) > uint(params.voxel_capacity) || axes == 0 ? 0 : first << 3 | axes;
}

uint foundAt(ivec3 cell, int cascade) {
    return foundIn(voxelBricks.words[wordNumber(cell, cascade)], bitOfCell(cell));
}

// Of a cell as textures hold it.
uint foundAtStored(ivec3 stored) {
    int cascade = cascadeOf(stored);
    return foundAt(ivec3(stored.xy, stored.z - cascade * params.voxel_dim), cascade);
}

#endif
