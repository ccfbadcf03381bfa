#version 460
#extension GL_GOOGLE_include_directive : require
// Marks the cells of scrolled surfels at their new positions.
#include "params.glsl"
#include "volume/volume.glsl"
#include "voxels/voxels.glsl"
#include "voxels/occupy.glsl"
#include "voxels/scrolled.glsl"

layout(local_size_x = 128) in;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= scrolledCounter.count) return;
    uint word = scrolledSurfels.words[i * SCROLLED_WORDS + SURFEL_CELL];
    occupy(unpackCell(word), (word >> 30) - 1);
}
