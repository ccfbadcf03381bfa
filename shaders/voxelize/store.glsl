// What a fragment or a point leaves behind: an entry of the fragment list, merged into its voxel by
// merge.comp. Six words and at most three atomics here; the sums are made where all of the chip can help.
#ifndef STORE_VOXEL_GLSL
#define STORE_VOXEL_GLSL
#include "common/volume.glsl"
#include "common/voxels.glsl"
#include "common/bricks.glsl"

// Notes that a cell has surfaces along an axis. Only the first invocation that comes to a word of a brick lists it, and none waits
// for it.
void occupy(ivec3 cell, int cascade, uint axis) {
    uint word = wordNumber(cell, cascade), bit = bitOfCell(cell);
    if ((voxelBricks.words[word][axis] & bit) != 0) return;
    if (atomicOr(voxelBricks.words[word][axis], bit) != 0) return;
    if (atomicOr(voxelBricks.words[word].w, 1u) != 0) return; // which count.comp gives its meaning
    voxelWords.list[atomicAdd(voxelCounter.words, 1)] = word;
    ivec3 brick = cell >> 2;
    atomicOr(voxelBlocks.masks[blockNumber(cell, cascade) + wordOfCell(brick)], bitOfCell(brick));
}

// color in [0,1], normal unit, emission radiance. `cascade`: of the volume. `at`: a point of the surface near the cell's
// middle, in cells. `triangle`: that may cover a part of the cell alone.
void storeVoxel(ivec3 cell, int cascade, vec3 color, vec3 normal, vec3 emission, vec3 at, uvec2 triangle) {
    if (isKept(volume.maps[cascade], vec3(cell) + 0.5)) return;
    ivec3 stored = storedCell(cell, cascade);
    uint packed = packDirection(normal), axis = axisOf(unpackDirection(packed)); // as merge.comp will read it
    packed |= packOffset(at[axis] - float(cell[axis]) - 0.5);
    occupy(cell, cascade, axis);
    uint i = atomicAdd(voxelCounter.fragments, 1);
    if (i >= voxelFragments.list.length()) return;
    voxelFragments.list[i] = uvec4(packCell(stored), packColor(color), packed, packRadiance(emission));
    voxelTriangles.list[i] = triangle;
}

#endif
