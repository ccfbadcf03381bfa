#version 460
#extension GL_GOOGLE_include_directive : require
// Starts a frame's voxel list. It takes the half of the frame before last, and the copy of the index that goes with it: what
// that half names is cleared. When a setting changed that decides about the list (the temporal filter fills cells beyond it)
// or it overflowed, every cell is cleared.
#include "params.glsl"
#include "common/volume.glsl"
#include "common/voxels.glsl"

layout(local_size_x = 1) in;

uint groupsFor(uint threads) {
    return min((threads + 127) / 128, 32768u);
}

void main() {
    uint dim = uint(params.voxel_dim), all = dim * dim * dim * uint(CASCADE_COUNT);
    uint last = min(voxelCounter.half_used, 1u), now = 1 - last;
    voxelCounter.half_used = now;
    voxelCounter.clear_slots = namesAll(last) ? voxelCounter.count : uint(params.voxel_capacity);
    voxelCounter.clear_cells = namesAll(now) ? cellsListed(now) : all;
    voxelCounter.clear_groups = uvec3(groupsFor(max(voxelCounter.clear_cells, voxelCounter.clear_slots)), 1, 1);
    voxelCounter.dim_groups = uvec3(groupsFor(namesAll(last) ? cellsListed(last) : all), 1, 1);
    voxelCounter.signature = params.voxel_signature;
    voxelCounter.cells[now] = 0;
    voxelCounter.kept = 0;
    voxelCounter.allocated = 0;
    voxelCounter.overflow = 0;
    voxelCounter.fragments = voxelCounter.words = 0;
}
