// Where surfaces are: cells in bricks of 4x4x4, bricks in blocks of 4x4x4. Only bricks with a surface are stored, in the order of their
// blocks. A block says which of its bricks those are and the number of the first: rays pass empty space in a cache, 16 bytes for 16^3
// cells. A brick has two words, 32 cells each: a bit each for facing along x, y and z, and the first of their surfels.
#ifndef BRICKS_GLSL
#define BRICKS_GLSL
#include "volume/volume.glsl"
#include "voxels/voxels.glsl"

layout(std430) buffer VoxelBlocks { uvec4 list[]; } voxelBlocks; // bits of 64 bricks; the first's number
layout(std430) buffer VoxelBricks { uvec4 words[]; } voxelBricks;
layout(std430) buffer VoxelPlaces { uint bricks[]; } voxelPlaces; // by a brick's number: 64 * its block + its place there

// Blocks along an edge of a cascade; the last ones may reach beyond it.
uint blocksAlong() {
    return (uint(params.voxel_dim) + 15u) / 16u;
}

uint blockIndex(ivec3 cell, int cascade) {
    uvec3 at = uvec3(cell) >> 4;
    uint edge = blocksAlong();
    return at.x + edge * (at.y + edge * (at.z + edge * uint(cascade)));
}

// The place of a cell in its brick, 0 to 63; a brick's in its block likewise, by its number of bricks from the corner.
uint placeOf(ivec3 cell) {
    return uint(cell.x) & 3u | (uint(cell.y) & 3u) << 2 | (uint(cell.z) & 3u) << 4;
}

// A place's word, 0 or 1, and its bit there.
uint wordOf(uint place) {
    return place >> 5;
}

uint bitOf(uint place) {
    return 1u << (place & 31u);
}

// The bits of the 2x2x2 cells that a place lies in: all of one word.
uint eightAround(uint place) {
    return 0x330033u << (place & 10u);
}

bool isStored(uvec4 block, uint brick) {
    return (block[wordOf(brick)] & bitOf(brick)) != 0;
}

// The number of a block's brick.
uint brickIndex(uvec4 block, uint brick) {
    uint before = bitCount(block[wordOf(brick)] & (bitOf(brick) - 1u));
    return block.z + before + (wordOf(brick) == 0 ? 0 : bitCount(block.x));
}

// The cell at a place of a brick, and its cascade.
ivec3 cellAt(uint brick, uint place, out int cascade) {
    uint edge = blocksAlong(), block = brick >> 6, z = block / (edge * edge);
    cascade = int(z / edge);
    uvec3 corner = uvec3(block % edge, block / edge % edge, z % edge) * 16u + 4u * uvec3(brick & 3u, brick >> 2 & 3u, brick >> 4 & 3u);
    return ivec3(corner + uvec3(place & 3u, place >> 2 & 3u, place >> 4));
}

// As textures hold it.
ivec3 storedCellAt(uint brick, uint place) {
    int cascade;
    ivec3 cell = cellAt(brick, place, cascade);
    return storedCell(cell, cascade);
}

uint occupiedCells(uvec4 word) {
    return word.x | word.y | word.z;
}

// What a word says of a cell: along which axes its surfaces face, three bits, and above them the first of as many surfels. 0: it has none,
// or the list of surfels had no room left.
uint foundIn(uvec4 word, uint bit) {
    uint axes = uint((word.x & bit) != 0) | uint((word.y & bit) != 0) << 1 | uint((word.z & bit) != 0) << 2, before = bit - 1u;
    uint first = word.w + bitCount(word.x & before) + bitCount(word.y & before) + bitCount(word.z & before);
    return first + bitCount(axes) > uint(params.voxel_capacity) || axes == 0 ? 0 : first << 3 | axes;
}

uint foundAt(ivec3 cell, int cascade) {
    uvec4 block = voxelBlocks.list[blockIndex(cell, cascade)];
    uint brick = placeOf(cell >> 2), place = placeOf(cell);
    return isStored(block, brick) ? foundIn(voxelBricks.words[2 * brickIndex(block, brick) + wordOf(place)], bitOf(place)) : 0;
}

// Of a cell as textures hold it.
uint foundAtStored(ivec3 stored) {
    int cascade = cascadeOf(stored);
    return foundAt(cellOfStored(stored, cascade), cascade);
}

#endif
