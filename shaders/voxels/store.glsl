// What a fragment or a point leaves behind: an entry of the fragment list, merged into its voxel by
// merge.comp. Six words and at most two atomics here; the sums are made where all of the chip can help.
#ifndef STORE_VOXEL_GLSL
#define STORE_VOXEL_GLSL
#include "volume/volume.glsl"
#include "voxels/voxels.glsl"
#include "voxels/bricks.glsl"

// Notes that a cell's brick has a surface. Most invocations find that another has said so.
void store(ivec3 cell, int cascade) {
    uint block = blockIndex(cell, cascade), brick = placeOf(cell >> 2);
    if ((voxelBlocks.list[block][wordOf(brick)] & bitOf(brick)) == 0) atomicOr(voxelBlocks.list[block][wordOf(brick)], bitOf(brick));
}

// color in [0,1], normal unit, emission radiance. `cascade`: of the volume. `at`: a point of the surface near the cell's
// middle, in cells. `triangle`: that may cover a part of the cell alone.
void storeVoxel(ivec3 cell, int cascade, vec3 color, vec3 normal, vec3 emission, vec3 at, uvec2 triangle) {
    if (isReprojected(volume.maps[cascade], vec3(cell) + 0.5)) return;
    ivec3 stored = storedCell(cell, cascade);
    uint packed = packDirection(normal), axis = axisOf(unpackDirection(packed)); // as who reads it will
    packed |= packOffset(at[axis] - float(cell[axis]) - 0.5);
    uint i = atomicAdd(voxelCounter.fragments, 1);
    if (i >= voxelFragments.list.length()) return;
    store(cell, cascade);
    voxelFragments.list[i] = uvec4(packCell(stored), packColor(color), packed, packRadiance(emission));
    voxelTriangles.list[i] = triangle;
}

#endif
