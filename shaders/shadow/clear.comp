#version 460
#extension GL_GOOGLE_include_directive : require
// Clears to the farthest depth. A compute pass, because an image clear takes as long as drawing the map on a
// chip with few rasterisers.
#include "params.glsl"

layout(local_size_x = 32, local_size_y = 4) in;

layout(r32ui) uniform writeonly uimage2DArray shadowWords;

void main() {
    imageStore(shadowWords, ivec3(gl_GlobalInvocationID), uvec4(floatBitsToUint(1.0)));
}
