#version 460
#extension GL_GOOGLE_include_directive : require
// Starts a frame's voxel list: last frame's becomes the list to clear. When a setting changed
// that decides about the list (the temporal filter fills cells beyond it) or it overflowed, every cell is cleared.
#include "params.glsl"
#include "common/volume.glsl"
#include "common/voxels.glsl"

layout(local_size_x = 1) in;

void main() {
    uint dim = uint(params.voxel_dim);
    bool all = voxelCounter.signature != params.voxel_signature || voxelCounter.overflow != 0;
    voxelCounter.clear_all = all ? 1u : 0u;
    voxelCounter.clear_count = all ? dim * dim * dim * uint(CASCADE_COUNT) : min(voxelCounter.allocated, uint(params.voxel_capacity));
    voxelCounter.clear_groups = uvec3(min((voxelCounter.clear_count + 127) / 128, 32768u), 1, 1);
    voxelCounter.signature = params.voxel_signature;
    voxelCounter.kept = 0;
    voxelCounter.allocated = 0;
    voxelCounter.overflow = 0;
    voxelCounter.fragments = 0;
}
