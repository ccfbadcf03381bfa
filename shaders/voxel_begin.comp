#version 460
#extension GL_GOOGLE_include_directive : require
// Starts a frame's voxel list: last frame's becomes the list to clear. When the sizes changed, the
// temporal filter (which fills cells beyond the list) was switched or the list overflowed, every cell is cleared.
#define COUNTER_ACCESS
#include "params.glsl"
#include "volume.glsl"
#include "voxels.glsl"

layout(local_size_x = 1) in;

void main() {
    uint dim = uint(params.voxel_dim);
    uint capacity = uint(params.voxel_capacity);
    bool all = voxelCounter.capacity != capacity || voxelCounter.dim != dim
            || voxelCounter.overflow != 0 || voxelCounter.signature != voxelSignature();
    voxelCounter.clear_all = all ? 1u : 0u;
    voxelCounter.clear_count = all ? dim * dim * dim * uint(BLOCKS) : min(voxelCounter.allocated, capacity);
    voxelCounter.clear_groups = uvec3(min((voxelCounter.clear_count + 127) / 128, 32768u), 1, 1);
    voxelCounter.capacity = capacity;
    voxelCounter.dim = dim;
    voxelCounter.signature = voxelSignature();
    voxelCounter.kept = 0;
    voxelCounter.allocated = 0;
    voxelCounter.overflow = 0;
    voxelCounter.fragments = 0;
}
