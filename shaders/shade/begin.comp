#version 460
#extension GL_GOOGLE_include_directive : require
// Nothing is listed yet.
#include "params.glsl"
#include "shade/list.glsl"

layout(local_size_x = 1) in;

void main() {
    gatherCounter.count = 0;
    gatherCounter.groups = uvec3(0, 1, 1);
}
