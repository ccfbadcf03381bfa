#version 460
#extension GL_GOOGLE_include_directive : require
// Arguments of the passes that put kept slots back.
#include "params.glsl"
#include "common/volume.glsl"
#include "common/voxels.glsl"

layout(local_size_x = 1) in;

void main() {
    voxelCounter.kept_groups = uvec3(min((voxelCounter.kept + 127) / 128, 65535u), 1, 1);
}
