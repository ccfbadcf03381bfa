#version 460
#extension GL_GOOGLE_include_directive : require
// Nothing is before the farthest depth. Here and not by a clear of the image, which on a chip with few rasterisers takes as long as
// drawing the map.
#include "params.glsl"

layout(local_size_x = 32, local_size_y = 4) in;

layout(r32ui) uniform writeonly uimage2DArray shadowWords;

void main() {
    imageStore(shadowWords, ivec3(gl_GlobalInvocationID), uvec4(floatBitsToUint(1.0)));
}
