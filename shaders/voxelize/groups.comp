#version 460
#extension GL_GOOGLE_include_directive : require
// Arguments of the passes that run over slots.
#include "params.glsl"
#include "common/volume.glsl"
#include "common/voxels.glsl"

layout(local_size_x = 1) in;

void main() {
    uint count = min(voxelCounter.allocated, uint(params.voxel_capacity));
    voxelCounter.count = count;
    voxelCounter.list_groups = uvec3((count + 127) / 128, 1, 1);
    voxelCounter.side_groups = uvec3(min((count * SIDES + 127) / 128, 65535u), 1, 1);
}
