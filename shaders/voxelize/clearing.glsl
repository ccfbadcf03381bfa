// The cells that a half of the list names, or all: clearing the whole volume would cost more than voxelizing.
#ifndef CLEARING_GLSL
#define CLEARING_GLSL
#include "common/volume.glsl"
#include "common/voxels.glsl"

uint cellsToClear(uint half_used) {
    uint dim = uint(params.voxel_dim);
    return namesAll(half_used) ? cellsListed(half_used) : dim * dim * dim * uint(CASCADE_COUNT);
}

ivec3 cellToClear(uint half_used, uint i) {
    uint dim = uint(params.voxel_dim);
    if (!namesAll(half_used)) return ivec3(i % dim, i / dim % dim, i / (dim * dim));
    return unpackCell(voxelCells.list[half_used * roomForCells() + i]);
}

#endif
