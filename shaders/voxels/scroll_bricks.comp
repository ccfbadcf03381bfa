#version 460
#extension GL_GOOGLE_include_directive : require
// Stores the bricks of scrolled surfels at their new positions.
#include "params.glsl"
#include "voxels/store.glsl"
#include "voxels/scrolled.glsl"

layout(local_size_x = 128) in;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= scrolledCounter.count) return;
    ivec3 stored = unpackCell(scrolledSurfels.words[i * SCROLLED_WORDS + SURFEL_CELL]);
    int cascade = cascadeOf(stored);
    store(cellOfStored(stored, cascade), cascade);
}
