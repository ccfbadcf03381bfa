// Marks a cell of a stored brick as occupied by surfaces along an axis.
#ifndef OCCUPY_GLSL
#define OCCUPY_GLSL
#include "voxels/bricks.glsl"

void occupy(ivec3 stored, uint axis) {
    int cascade = cascadeOf(stored);
    ivec3 cell = cellOfStored(stored, cascade);
    uvec4 block = voxelBlocks.list[blockIndex(cell, cascade)];
    uint brick = indexInBrick(cell >> 2), local = indexInBrick(cell);
    if (!isStored(block, brick)) return;
    uint word = 2 * brickIndex(block, brick) + wordOf(local);
    if ((voxelBricks.words[word][axis] & bitOf(local)) == 0)
        atomicOr(voxelBricks.words[word][axis], bitOf(local));
}

#endif
