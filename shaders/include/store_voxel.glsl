// Storing a fragment or a point into the voxel list, under one of three merge rules.
#ifndef STORE_VOXEL_GLSL
#define STORE_VOXEL_GLSL
#define SLOTS_ACCESS
#define COUNTER_ACCESS
#include "voxels.glsl"

layout(r32ui) coherent uniform uimage3D voxelIndex;

uint slotOf(ivec3 cell) {
    uint found = imageLoad(voxelIndex, cell).r;
    if (found == 0) {
        uint slot = atomicAdd(voxelCounter.allocated, 1);
        if (slot >= uint(params.voxel_capacity)) {
            atomicAdd(voxelCounter.overflow, 1);
            return NO_SLOT;
        }
        found = imageAtomicCompSwap(voxelIndex, cell, 0, slot + 1);
        if (found == 0) {
            voxelSlots.words[slot * SLOT_WORDS + SLOT_CELL] = packCell(cell);
            return slot;
        }
        // Another invocation was first; our slot stays unused.
    }
    return found - 1;
}

// Running mean in eight bits with the count in the top byte (Crassin and Green 2012). Kept to show its
// errors: it truncates at each step, wraps after 255 fragments and depends on their order.
void runningAverage(uint word, vec3 value) {
    vec4 added = vec4(value * 255.0, 1.0);
    uvec4 v = uvec4(added);
    uint next = v.x | v.y << 8 | v.z << 16 | v.w << 24;
    uint expected = 0;
    for (int i = 0; i < 1024; i++) {
        uint seen = atomicCompSwap(voxelSlots.words[word], expected, next);
        if (seen == expected) return;
        expected = seen;
        vec4 mean = vec4(seen & 255u, seen >> 8 & 255u, seen >> 16 & 255u, seen >> 24);
        vec4 sum = vec4(mean.rgb * mean.a, mean.a) + added;
        v = uvec4(vec4(sum.rgb / sum.a, sum.a)) & 255u;
        next = v.x | v.y << 8 | v.z << 16 | v.w << 24;
    }
}

// color in [0,1], normal unit, emission radiance.
void storeVoxel(ivec3 cell, vec3 color, vec3 normal, vec3 emission) {
    uint slot = slotOf(cell);
    if (slot == NO_SLOT) return;
    uint base = slot * SLOT_WORDS;
    if (MERGE == MERGE_AVERAGE) {
        uvec3 c = uvec3(clamp(color, 0.0, 1.0) * COLOR_SCALE + 0.5);
        ivec3 n = ivec3(round(normal * NORMAL_SCALE));
        for (uint i = 0; i < 3; i++) {
            atomicAdd(voxelSlots.words[base + i], c[i]);
            atomicAdd(voxelSlots.words[base + 4 + i], uint(n[i])); // two's complement: wraps to the right sum
        }
    } else if (MERGE == MERGE_RUNNING_AVERAGE) {
        runningAverage(base, clamp(color, 0.0, 1.0));
        runningAverage(base + 4, normal * 0.5 + 0.5);
    } else {
        // The largest packed word wins: blue is compared first.
        atomicMax(voxelSlots.words[base], packUnorm4x8(vec4(color, 1.0)));
        atomicMax(voxelSlots.words[base + 4], packUnorm4x8(vec4(normal * 0.5 + 0.5, 1.0)));
    }
    atomicAdd(voxelSlots.words[base + 3], 1);
    if (emission != vec3(0.0)) {
        uvec3 e = uvec3(clamp(emission, 0.0, EMISSION_MAX) * EMISSION_SCALE + 0.5);
        for (uint i = 0; i < 3; i++) atomicAdd(voxelSlots.words[base + 7 + i], e[i]);
    }
}

#endif
