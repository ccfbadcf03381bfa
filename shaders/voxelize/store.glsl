// What a fragment or a point leaves behind: an entry of the fragment list, merged into its voxel by
// merge.comp. Sixteen bytes and at most two atomics here; the sums are made where all of the chip can help.
#ifndef STORE_VOXEL_GLSL
#define STORE_VOXEL_GLSL
#include "common/volume.glsl"
#include "common/voxels.glsl"

layout(r32ui) coherent uniform uimage3D voxelIndex;

// Gives a cell its slot. Only the first invocation that comes does so, and none waits for it.
void occupy(ivec3 cell) {
    if (imageLoad(voxelIndex, cell).r != 0 || imageAtomicCompSwap(voxelIndex, cell, 0, CELL_FULL) != 0) return;
    uint slot = atomicAdd(voxelCounter.allocated, 1);
    if (slot >= uint(params.voxel_capacity)) return; // stays marked as full
    voxelSlots.words[slot * SLOT_WORDS + SLOT_CELL] = packCell(cell);
    imageStore(voxelIndex, cell, uvec4(slot + 1));
}

// color in [0,1], normal unit, emission radiance. `cascade`: of the volume.
void storeVoxel(ivec3 cell, int cascade, vec3 color, vec3 normal, vec3 emission) {
    if (isKept(volume.maps[cascade], vec3(cell) + 0.5)) return;
    cell = storedCell(cell, cascade);
    occupy(cell);
    uint i = atomicAdd(voxelCounter.fragments, 1);
    if (i < voxelFragments.list.length())
        voxelFragments.list[i] = uvec4(packCell(cell), packColor(color), packNormal(normal), packRadiance(emission));
}

#endif
