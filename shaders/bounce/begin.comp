#version 460
#extension GL_GOOGLE_include_directive : require
// No side gathers yet.
#include "params.glsl"
#include "bounce/list.glsl"

layout(local_size_x = 1) in;

void main() {
    bounceCounter.count = 0;
    bounceCounter.groups = uvec3(0, 1, 1);
}
