#version 460
#extension GL_GOOGLE_include_directive : require
// Sets aside the slots that this frame's volume takes over from last frame's, before they are cleared.
#include "params.glsl"
#include "common/volume.glsl"
#include "common/voxels.glsl"
#include "voxelize/kept.glsl"

layout(local_size_x = 128) in;

void main() {
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint i = gl_GlobalInvocationID.x; i < voxelCounter.count; i += stride) {
        int axis = axisOfSlot(i);
        ivec3 stored = cellOfSlot(i);
        int cascade = cascadeOf(stored);
        VolumeMap map = volume.maps[cascade];
        ivec3 cell = ivec3(stored.xy, stored.z - cascade * params.voxel_dim) - map.shift;
        if (axis < 0 || !isKept(map, vec3(cell) + 0.5)) continue;
        uint to = atomicAdd(keptCounter.count, 1);
        for (uint word = 0; word < SLOT_CELL; word++) voxelKept.words[to * SLOT_WORDS + word] = voxelSlots.words[i * SLOT_WORDS + word];
        voxelKept.words[to * SLOT_WORDS + SLOT_CELL] = packCell(storedCell(cell, cascade)) | uint(axis + 1) << 30;
    }
}
