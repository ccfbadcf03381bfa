// Sparse grid of occupied cells: bricks of 4x4x4 cells, in blocks of 4x4x4 bricks. Only bricks with a surface
// are stored, in block order. A block has a bit for each stored brick and the index of the first: 16 bytes
// for 16^3 cells, so rays cross empty space in cache. A brick has two words of 32 cells. Each word has one
// bit per cell and axis that its surfaces face, and the index of the first surfel.
#ifndef BRICKS_GLSL
#define BRICKS_GLSL
#include "volume/volume.glsl"
#include "voxels/voxels.glsl"

layout(std430) buffer VoxelBlocks { uvec4 list[]; } voxelBlocks; // xy: bits of 64 bricks; z: first index
layout(std430) buffer VoxelBricks { uvec4 words[]; } voxelBricks;
// Holds 64 * block + index in the block for each brick index.
layout(std430) buffer VoxelBrickIds { uint bricks[]; } voxelBrickIds;

// Blocks along an edge of a cascade. The last ones may extend beyond it.
uint blocksAlong() {
    return (uint(params.voxel_dim) + 15u) / 16u;
}

uint blockIndex(ivec3 cell, int cascade) {
    uvec3 at = uvec3(cell) >> 4;
    uint edge = blocksAlong();
    return at.x + edge * (at.y + edge * (at.z + edge * uint(cascade)));
}

// Index of a cell in its brick, 0 to 63. With brick coordinates, the index of a brick in its block.
uint indexInBrick(ivec3 cell) {
    return uint(cell.x) & 3u | (uint(cell.y) & 3u) << 2 | (uint(cell.z) & 3u) << 4;
}

// Word of an index in a brick, 0 or 1.
uint wordOf(uint local) {
    return local >> 5;
}

// Bit of an index within its word.
uint bitOf(uint local) {
    return 1u << (local & 31u);
}

// Bits of the aligned 2x2x2 cells around an index. All are in the same word.
uint eightAround(uint local) {
    return 0x330033u << (local & 10u);
}

bool isStored(uvec4 block, uint brick) {
    return (block[wordOf(brick)] & bitOf(brick)) != 0;
}

// Index of a stored brick of a block.
uint brickIndex(uvec4 block, uint brick) {
    uint before = bitCount(block[wordOf(brick)] & (bitOf(brick) - 1u));
    return block.z + before + (wordOf(brick) == 0 ? 0 : bitCount(block.x));
}

// Cell at an index in a brick, and its cascade. `brick`: 64 * block + index in the block.
ivec3 cellAt(uint brick, uint local, out int cascade) {
    uint edge = blocksAlong(), block = brick >> 6, z = block / (edge * edge);
    cascade = int(z / edge);
    uvec3 corner = uvec3(block % edge, block / edge % edge, z % edge) * 16u
        + 4u * uvec3(brick & 3u, brick >> 2 & 3u, brick >> 4 & 3u);
    return ivec3(corner + uvec3(local & 3u, local >> 2 & 3u, local >> 4));
}

// The same in texture coordinates.
ivec3 storedCellAt(uint brick, uint local) {
    int cascade;
    ivec3 cell = cellAt(brick, local, cascade);
    return storedCell(cell, cascade);
}

uint occupiedCells(uvec4 word) {
    return word.x | word.y | word.z;
}

// Lookup of a cell in a word. Bits 0 to 2: axes that its surfaces face; above: index of its first surfel. 0
// if the cell is empty or its surfels are beyond the capacity.
uint foundIn(uvec4 word, uint bit) {
    uint axes = uint((word.x & bit) != 0) | uint((word.y & bit) != 0) << 1 | uint((word.z & bit) != 0) << 2,
        before = bit - 1u;
    uint first = word.w + bitCount(word.x & before) + bitCount(word.y & before) + bitCount(word.z & before);
    return first + bitCount(axes) > uint(params.voxel_capacity) || axes == 0 ? 0 : first << 3 | axes;
}

uint foundAt(ivec3 cell, int cascade) {
    uvec4 block = voxelBlocks.list[blockIndex(cell, cascade)];
    uint brick = indexInBrick(cell >> 2), local = indexInBrick(cell);
    return isStored(block, brick) ?
        foundIn(voxelBricks.words[2 * brickIndex(block, brick) + wordOf(local)], bitOf(local)) : 0;
}

// Lookup of a cell in texture coordinates.
uint foundAtStored(ivec3 stored) {
    int cascade = cascadeOf(stored);
    return foundAt(cellOfStored(stored, cascade), cascade);
}

#endif
