#version 460
#extension GL_GOOGLE_include_directive : require
// Begins the maps with what never moves.
#include "params.glsl"

layout(local_size_x = 32, local_size_y = 4) in;

layout(r32ui) uniform readonly uimage2DArray stillWords;
layout(r32ui) uniform writeonly uimage2DArray shadowWords;

void main() {
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    imageStore(shadowWords, texel, imageLoad(stillWords, texel));
}
