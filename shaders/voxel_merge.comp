#version 460
#extension GL_GOOGLE_include_directive : require
// Merges the fragments into their voxels (thesis, Section 4.1.1, last paragraphs) under one of three rules.
#define SLOTS_ACCESS
#define COUNTER_ACCESS
#define FRAGMENTS_ACCESS readonly
#include "params.glsl"
#include "volume.glsl"
#include "voxels.glsl"

layout(local_size_x = 128) in;

layout(r32ui) uniform readonly uimage3D voxelIndex;

// Neighbours in the list mostly hit the same voxel: neighbouring threads take fragments that lie far apart, so that
// their atomics do not queue.
const uint SHARES = 1u << 16;

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

void merge(uint base, vec3 color, vec3 normal, uint emission) {
    if (MERGE == MERGE_AVERAGE) {
        uvec3 c = uvec3(color * COLOR_SCALE + 0.5);
        ivec3 n = ivec3(round(normal * NORMAL_SCALE));
        for (uint i = 0; i < 3; i++) {
            atomicAdd(voxelSlots.words[base + i], c[i]);
            atomicAdd(voxelSlots.words[base + 4 + i], uint(n[i])); // two's complement: wraps to the right sum
        }
    } else if (MERGE == MERGE_RUNNING_AVERAGE) {
        runningAverage(base, color);
        runningAverage(base + 4, normal * 0.5 + 0.5);
    } else {
        // The largest packed word wins: blue is compared first.
        atomicMax(voxelSlots.words[base], packUnorm4x8(vec4(color, 1.0)));
        atomicMax(voxelSlots.words[base + 4], packUnorm4x8(vec4(normal * 0.5 + 0.5, 1.0)));
    }
    atomicAdd(voxelSlots.words[base + 3], 1);
    if (emission != 0) {
        uvec3 e = uvec3(min(unpackRadiance(emission), EMISSION_MAX) * EMISSION_SCALE + 0.5);
        for (uint i = 0; i < 3; i++) atomicAdd(voxelSlots.words[base + 7 + i], e[i]);
    }
}

void main() {
    uint count = min(voxelCounter.fragments, voxelFragments.list.length());
    uint share = (count + SHARES - 1) / SHARES;
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint t = gl_GlobalInvocationID.x; t < share * SHARES; t += stride) {
        uint i = t % SHARES * share + t / SHARES;
        if (i >= count) continue;
        uvec4 fragment = voxelFragments.list[i];
        uint found = imageLoad(voxelIndex, unpackCell(fragment.x)).r;
        if (found == CELL_FULL) atomicAdd(voxelCounter.overflow, 1);
        else merge((found - 1) * SLOT_WORDS, unpackColor(fragment.y), unpackNormal(fragment.z), fragment.w);
    }
}
