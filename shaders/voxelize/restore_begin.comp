#version 460
#extension GL_GOOGLE_include_directive : require
// Arguments of the passes that put kept slots back.
#include "params.glsl"
#include "voxelize/kept.glsl"

layout(local_size_x = 1) in;

void main() {
    keptCounter.groups = uvec3(min((keptCounter.count + 127) / 128, 65535u), 1, 1);
}
