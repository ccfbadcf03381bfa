// The sparse list of voxels. A cell of `voxelIndex` holds 0, slot + 1 or CELL_FULL; a slot holds the sums
// of what fell into the cell. The sums are integers, so their order does not matter and runs agree to the bit.
#ifndef VOXELS_GLSL
#define VOXELS_GLSL

const uint SLOT_WORDS = 12; // colour 0-2, count 3, normal 4-6, emission 7-9, unused 10, cell 11
const uint SLOT_CELL = 11;
const uint CELL_FULL = 0xffffffffu; // occupied, but the list had no slot left

// Fixed point. Colour and normal do not overflow below 2^20 fragments a voxel; emission below
// 4e6 / radiance fragments.
const float COLOR_SCALE = 4095.0;
const float NORMAL_SCALE = 2047.0;
const float EMISSION_SCALE = 1024.0;
const float EMISSION_MAX = 1024.0;

layout(std430) buffer VoxelSlots { uint words[]; } voxelSlots;
layout(std430) buffer VoxelCounter {
    uint allocated; // slots asked for, this frame: as many as occupied cells
    uint overflow; // fragments that were lost: the list of voxels or of fragments was full
    uint count; // slots in the list: min(allocated, voxel_capacity)
    uint fragments; // stored, this frame
    uvec3 list_groups; // indirect dispatch over the list, 128 threads a group
    uint clear_count;
    uvec3 clear_groups; // indirect dispatch that clears last frame's list
    uint clear_all; // 1: the list does not name every set cell, clear them all
    uint signature; // of the settings that the list was built with
    uint kept; // slots that stay as they are, this frame
    uvec3 merge_groups; // indirect dispatch over the fragments
    uvec3 kept_groups; // indirect dispatch over what is kept
} voxelCounter;

// Cell, colour, normal, emission of each fragment, in no order.
layout(std430) buffer VoxelFragments { uvec4 list[]; } voxelFragments;

uint packColor(vec3 c) {
    uvec3 v = uvec3(clamp(c, 0.0, 1.0) * vec3(2047.0, 2047.0, 1023.0) + 0.5);
    return v.r | v.g << 11 | v.b << 22;
}

vec3 unpackColor(uint w) {
    return vec3(w & 2047u, w >> 11 & 2047u, w >> 22) / vec3(2047.0, 2047.0, 1023.0);
}

// Octahedral (Cigolle et al. 2014); 0 is no normal.
uint packNormal(vec3 n) {
    float sum = abs(n.x) + abs(n.y) + abs(n.z);
    if (sum == 0.0) return 0;
    n /= sum;
    vec2 fold = (1.0 - abs(n.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(n.xy, vec2(0.0)));
    vec2 o = n.z >= 0.0 ? n.xy : fold;
    uvec2 v = uvec2(o * 32767.0 + 32768.5);
    return v.x | v.y << 16;
}

vec3 unpackNormal(uint w) {
    if (w == 0) return vec3(0.0);
    vec2 o = (vec2(w & 0xffffu, w >> 16) - 32768.0) / 32767.0;
    vec3 n = vec3(o, 1.0 - abs(o.x) - abs(o.y));
    if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(n.xy, vec2(0.0)));
    return normalize(n);
}

// Nine bits a channel and a shared exponent (EXT_texture_shared_exponent); up to 65408.
uint packRadiance(vec3 c) {
    c = clamp(c, 0.0, 65408.0);
    float largest = max(c.r, max(c.g, c.b));
    if (largest < 1e-6) return 0;
    int exponent = clamp(int(floor(log2(largest))) + 16, 0, 31);
    if (largest / exp2(float(exponent - 24)) >= 511.5) exponent = min(exponent + 1, 31);
    uvec3 v = uvec3(c / exp2(float(exponent - 24)) + 0.5);
    return v.r | v.g << 9 | v.b << 18 | uint(exponent) << 27;
}

vec3 unpackRadiance(uint w) {
    return vec3(w & 511u, w >> 9 & 511u, w >> 18 & 511u) * exp2(float(w >> 27) - 24.0);
}

// x, y: up to 512; z: as many for each cascade.
uint packCell(ivec3 c) {
    return uint(c.x | c.y << 9 | c.z << 18);
}

ivec3 unpackCell(uint word) {
    return ivec3(word & 511u, word >> 9 & 511u, word >> 18);
}

ivec3 cellOfSlot(uint slot) {
    return unpackCell(voxelSlots.words[slot * SLOT_WORDS + SLOT_CELL]);
}

vec3 meanEmission(uint slot) {
    uint base = slot * SLOT_WORDS;
    float count = float(max(voxelSlots.words[base + 3], 1u));
    return vec3(voxelSlots.words[base + 7], voxelSlots.words[base + 8], voxelSlots.words[base + 9]) / (EMISSION_SCALE * count);
}

#endif
