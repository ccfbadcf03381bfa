#version 460
#extension GL_GOOGLE_include_directive : require
// Puts the cells of the kept slots back, where they are now.
#include "params.glsl"
#include "voxelize/store.glsl"
#include "voxelize/kept.glsl"

layout(local_size_x = 128) in;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= keptCounter.count) return;
    uint word = voxelKept.words[i * SLOT_WORDS + SLOT_CELL];
    ivec3 stored = unpackCell(word);
    int cascade = cascadeOf(stored);
    occupy(ivec3(stored.xy, stored.z - cascade * params.voxel_dim), cascade, (word >> 30) - 1);
}
