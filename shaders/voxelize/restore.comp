#version 460
#extension GL_GOOGLE_include_directive : require
// Puts the kept voxels back, where they are now.
#include "params.glsl"
#include "common/volume.glsl"
#include "common/voxels.glsl"
#include "voxelize/kept.glsl"

layout(local_size_x = 128) in;

layout(r32ui) uniform writeonly uimage3D voxelIndex;

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= voxelCounter.kept) return;
    for (uint word = 0; word < SLOT_WORDS; word++) voxelSlots.words[slot * SLOT_WORDS + word] = voxelKept.words[slot * SLOT_WORDS + word];
    imageStore(voxelIndex, unpackCell(voxelKept.words[slot * SLOT_WORDS + SLOT_CELL]), uvec4(slot + 1));
}
