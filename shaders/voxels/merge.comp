#version 460
#extension GL_GOOGLE_include_directive : require
// Merges fragments into their surfels (thesis, Section 4.1.1, last paragraphs). modules/merge has the rules.
#include "params.glsl"
#include "volume/volume.glsl"
#include "voxels/bricks.glsl"
#include "surfels/surfels.glsl"
#include "voxels/fragment_coverage.glsl"

layout(local_size_x = 128) in;

// Consecutive fragments mostly hit the same voxel. Neighbouring threads therefore take fragments that are far
// apart in the list, so that their atomics do not contend.
const uint SHARES = 1u << 16;

#include "modules/merge.glsl"

// Merges a surface into the front layer of each quarter. Most sides have one surface, and the loop runs once.
void mergeFrontLayer(uint word, uint side, Coverage coverage) {
    uint mine = 0;
    for (uint i = 0; i < 4; i++) {
        uvec2 quarter = quarterOf(coverage.mask, i);
        int count = bitCount(quarter.x) + bitCount(quarter.y);
        if (count > 0) mine |= packFrontLayer(coverage.offset, side, count) << 8 * i;
    }
    uint found = surfelData(word);
    for (;;) {
        uint seen = atomicCompSwap(surfels.quads[word >> 2][word & 3u], found, frontOf(found, mine));
        if (seen == found) return;
        found = seen;
    }
}

void merge(uint base, vec3 color, vec3 normal, float offset, uint emission, uint weight) {
    mergeInto(base, color, normal, weight);
    atomicAdd(surfelSums.words[base + SIDE_OFFSET], storedOffset(offset) * weight);
    atomicAdd(surfelSums.words[base + 3], weight);
    if (emission != 0) {
        uvec3 e = uvec3(min(unpackRadiance(emission), EMISSION_MAX) * EMISSION_SCALE * float(weight) + 0.5);
        for (uint i = 0; i < 3; i++) atomicAdd(surfelSums.words[base + 7 + i], e[i]);
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
        ivec3 stored = unpackCell(fragment.x);
        uint found = foundAtStored(stored);
        vec3 normal = unpackDirection(fragment.z);
        uint axis = axisOf(normal);
        if (found == 0) {
            atomicAdd(voxelCounter.overflow, 1);
            continue;
        }
        uvec2 triangle = voxelTriangles.list[i];
        Coverage coverage = fragmentCoverage(triangle, stored, axis, unpackOffset(fragment.z));
        if (coverage.weight == 0) continue;
        uint side = sideOf(normal, axis), surfel = surfelOf(found, axis), plane = surfelBase(surfel);
        merge(sideBase(surfel, side), unpackColor(fragment.y), normal, coverage.offset, fragment.w,
            coverage.weight);
        if (SIDES == 1) continue; // front layers and masks need two sides
        // Points and samples have no exact offset.
        if (triangle != NO_TRIANGLE) mergeFrontLayer(frontLayerWord(plane, side), side, coverage);
        for (uint k = 0; k < 2; k++) {
            uint word = coverageMaskWord(plane, side) + k;
            if ((surfelData(word) & coverage.mask[k]) != coverage.mask[k])
                atomicOr(surfels.quads[word >> 2][word & 3u], coverage.mask[k]);
        }
    }
}
