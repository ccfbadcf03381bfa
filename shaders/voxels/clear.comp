#version 460
#extension GL_GOOGLE_include_directive : require
// Clears all cells. Faster than clearing the image on a GPU with few rasterisers.
#include "params.glsl"

layout(local_size_x = 32, local_size_y = 4) in;

uniform writeonly image3D cleared;

void main() {
    imageStore(cleared, ivec3(gl_GlobalInvocationID), vec4(0.0));
}
