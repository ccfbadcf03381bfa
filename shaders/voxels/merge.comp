#version 460
#extension GL_GOOGLE_include_directive : require
// Merges fragments into their surfels (thesis, Section 4.1.1, last paragraphs). modules/merge has the rules.
#include "params.glsl"
#include "volume/volume.glsl"
#include "surfels/surfels.glsl"
#include "voxels/layers.glsl"
#include "voxels/shares.glsl"

layout(local_size_x = 128) in;

#include "modules/merge.glsl"

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
    uint count = fragmentCount(), share = shareOf(count), stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint step = gl_GlobalInvocationID.x; step < share * SHARES; step += stride) {
        uint i = fragmentOfStep(step, share);
        if (i >= count) continue;
        Layer layer = unpackLayer(voxelTriangles.list[i]);
        if (layer.weight == 0) continue;
        uvec4 fragment = voxelFragments.list[i];
        uint surfel = fragment.x / SIDES, side = fragment.x % SIDES;
        if (SIDES > 1) {
            uint front = surfelData(frontLayerWord(surfelBase(surfel), side));
            layer.weight = visibleWeight(layer, front, side);
        }
        if (layer.weight == 0) continue;
        merge(sideBase(surfel, side), unpackColor(fragment.y), unpackDirection(fragment.z), layer.offset,
            fragment.w, layer.weight);
    }
}
