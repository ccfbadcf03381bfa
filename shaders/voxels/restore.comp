#version 460
#extension GL_GOOGLE_include_directive : require
// Stores the bricks of the kept surfels, where they are now.
#include "params.glsl"
#include "voxels/store.glsl"
#include "voxels/kept.glsl"

layout(local_size_x = 128) in;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= keptCounter.count) return;
    ivec3 stored = unpackCell(voxelKept.words[i * KEPT_WORDS + SURFEL_CELL]);
    int cascade = cascadeOf(stored);
    store(cellOfStored(stored, cascade), cascade);
}
