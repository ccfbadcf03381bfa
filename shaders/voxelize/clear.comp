#version 460
#extension GL_GOOGLE_include_directive : require
// Clears the voxels that last frame's list names: clearing the whole volume would cost more than voxelizing.
#include "params.glsl"
#include "common/volume.glsl"
#include "common/voxels.glsl"

layout(local_size_x = 128) in;

layout(r32ui) uniform writeonly uimage3D voxelIndex;
uniform writeonly image3D voxelColor;
uniform writeonly image3D voxelNormal;
uniform writeonly image3D injected;

void clearCell(ivec3 cell) {
    imageStore(voxelIndex, cell, uvec4(0));
    imageStore(voxelColor, cell, vec4(0));
    imageStore(voxelNormal, cell, vec4(0));
    imageStore(injected, cell, vec4(0));
}

void main() {
    uint dim = uint(params.voxel_dim);
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint i = gl_GlobalInvocationID.x; i < voxelCounter.clear_count; i += stride) {
        clearCell(voxelCounter.clear_all != 0 ? ivec3(i % dim, i / dim % dim, i / (dim * dim)) : cellOfSlot(i));
        if (i < uint(params.voxel_capacity))
            for (uint word = 0; word < SLOT_WORDS; word++) voxelSlots.words[i * SLOT_WORDS + word] = 0;
    }
}
