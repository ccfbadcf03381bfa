#version 460
#extension GL_GOOGLE_include_directive : require
// The kept voxels are the first of the new list.
#include "params.glsl"
#include "common/volume.glsl"
#include "common/voxels.glsl"

layout(local_size_x = 1) in;

void main() {
    voxelCounter.allocated = voxelCounter.kept;
    voxelCounter.kept_groups = uvec3(min((voxelCounter.kept + 127) / 128, 65535u), 1, 1);
}
