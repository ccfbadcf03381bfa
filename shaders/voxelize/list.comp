#version 460
#extension GL_GOOGLE_include_directive : require
// Arguments of the passes that run over cells and fragments.
#include "params.glsl"
#include "common/volume.glsl"
#include "common/voxels.glsl"

layout(local_size_x = 1) in;

void main() {
    uint now = voxelCounter.half_used;
    voxelCounter.word_groups = uvec3(min((voxelCounter.words + 3) / 4, 65535u), 1, 1);
    voxelCounter.signatures[now] = params.voxel_signature;
    uint fragments = min(voxelCounter.fragments, voxelFragments.list.length());
    voxelCounter.overflow = voxelCounter.fragments - fragments;
    voxelCounter.merge_groups = uvec3(min((fragments + 127) / 128 + 1, 32768u), 1, 1);
}
