#version 460
#extension GL_GOOGLE_include_directive : require
// Marks the cells of all fragments, once their bricks are stored.
#include "params.glsl"
#include "volume/volume.glsl"
#include "voxels/voxels.glsl"
#include "voxels/occupy.glsl"

layout(local_size_x = 128) in;

void main() {
    uint count = min(voxelCounter.fragments, voxelFragments.list.length());
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        uvec4 fragment = voxelFragments.list[i];
        occupy(unpackCell(fragment.x), axisOf(unpackDirection(fragment.z)));
    }
}
