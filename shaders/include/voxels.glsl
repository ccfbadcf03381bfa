// The sparse list of voxels. A cell of `voxelIndex` holds 0 or slot + 1; a slot holds the sums of what fell
// into the cell. The sums are integers, so their order does not matter and runs agree to the bit.
#ifndef VOXELS_GLSL
#define VOXELS_GLSL

const uint SLOT_WORDS = 12; // colour 0-2, count 3, normal 4-6, emission 7-9, unused 10, cell 11
const uint SLOT_CELL = 11;
const uint CELL_VALID = 0x80000000u; // clear in slots that lost the race for their cell
const uint NO_SLOT = 0xffffffffu;

// Fixed point. Colour and normal do not overflow below 2^20 fragments a voxel; emission below
// 4e6 / radiance fragments.
const float COLOR_SCALE = 4095.0;
const float NORMAL_SCALE = 2047.0;
const float EMISSION_SCALE = 1024.0;
const float EMISSION_MAX = 1024.0;

#ifndef SLOTS_ACCESS
#define SLOTS_ACCESS readonly
#endif
#ifndef COUNTER_ACCESS
#define COUNTER_ACCESS readonly
#endif
layout(std430) SLOTS_ACCESS buffer VoxelSlots { uint words[]; } voxelSlots;
layout(std430) COUNTER_ACCESS buffer VoxelCounter {
    uint allocated; // slots asked for, this frame
    uint overflow; // requests beyond voxel_capacity
    uint count; // slots in the list: min(allocated, voxel_capacity)
    uint capacity; // that the list was built with
    uvec3 list_groups; // indirect dispatch over the list, 128 threads a group
    uint dim; // that the list was built with
    uvec3 clear_groups; // indirect dispatch that clears last frame's list
    uint clear_count;
    uvec4 draw; // indirect draw of a cube a slot
    uint clear_all; // 1: the list does not name every set cell, clear them all
    uint temporal; // that the list was built with
} voxelCounter;

uint packCell(ivec3 c) {
    return uint(c.x | c.y << 9 | c.z << 18) | CELL_VALID;
}

ivec3 unpackCell(uint word) {
    return ivec3(word & 511u, word >> 9 & 511u, word >> 18 & 511u);
}

// False for slots that hold no voxel.
bool cellOfSlot(uint slot, out ivec3 cell) {
    uint word = voxelSlots.words[slot * SLOT_WORDS + SLOT_CELL];
    cell = unpackCell(word);
    return (word & CELL_VALID) != 0;
}

vec3 meanEmission(uint slot) {
    uint base = slot * SLOT_WORDS;
    float count = float(max(voxelSlots.words[base + 3], 1u));
    return vec3(voxelSlots.words[base + 7], voxelSlots.words[base + 8], voxelSlots.words[base + 9]) / (EMISSION_SCALE * count);
}

#endif
