#version 460
#extension GL_GOOGLE_include_directive : require
// Gives the kept slots their sums back, once their cells have slots again.
#include "params.glsl"
#include "common/volume.glsl"
#include "common/voxels.glsl"
#include "voxelize/kept.glsl"

layout(local_size_x = 128) in;

layout(r32ui) uniform readonly uimage3D voxelIndex;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= voxelCounter.kept) return;
    uint packed = voxelKept.words[i * SLOT_WORDS + SLOT_CELL], found = imageLoad(voxelIndex, unpackCell(packed)).r;
    if (found == CELL_FULL) return;
    uint slot = slotOf(found, (packed >> 30) - 1);
    for (uint word = 0; word < SLOT_CELL; word++) voxelSlots.words[slot * SLOT_WORDS + word] = voxelKept.words[i * SLOT_WORDS + word];
}
