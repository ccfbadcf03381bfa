// Appends fragments or points to the fragment list. coverage.comp and merge.comp merge them into voxels.
// Costs six words and at most two atomics here; the sums are left to passes that fill the whole GPU.
#ifndef STORE_VOXEL_GLSL
#define STORE_VOXEL_GLSL
#include "volume/volume.glsl"
#include "voxels/voxels.glsl"
#include "voxels/bricks.glsl"

// Marks a cell's brick as stored. Most invocations find it already marked.
void store(ivec3 cell, int cascade) {
    uint block = blockIndex(cell, cascade), brick = indexInBrick(cell >> 2);
    if ((voxelBlocks.list[block][wordOf(brick)] & bitOf(brick)) == 0)
        atomicOr(voxelBlocks.list[block][wordOf(brick)], bitOf(brick));
}

// color: [0,1]. normal: unit length. emission: radiance. at: a point of the surface near the cell centre
// [cells]. triangle: computes partial coverage; NO_TRIANGLE covers the whole cell.
void storeVoxel(ivec3 cell, int cascade, vec3 color, vec3 normal, vec3 emission, vec3 at, uvec2 triangle) {
    if (isReprojected(volume.maps[cascade], vec3(cell) + 0.5)) return;
    ivec3 stored = storedCell(cell, cascade);
    uint packed = packDirection(normal), axis = axisOf(unpackDirection(packed)); // as readers will see it
    packed |= packOffset(at[axis] - float(cell[axis]) - 0.5);
    uint i = atomicAdd(voxelCounter.fragments, 1);
    if (i >= voxelFragments.list.length()) return;
    store(cell, cascade);
    voxelFragments.list[i] = uvec4(packCell(stored), packColor(color), packed, packRadiance(emission));
    voxelTriangles.list[i] = triangle;
}

#endif
