#version 460
#extension GL_GOOGLE_include_directive : require
// No voxel, in all cells. Here and not by a clear of the image, which takes longer than the rest on a chip with few rasterisers.
#include "params.glsl"

layout(local_size_x = 32, local_size_y = 4) in;

uniform writeonly image3D cleared;

void main() {
    imageStore(cleared, ivec3(gl_GlobalInvocationID), vec4(0.0));
}
