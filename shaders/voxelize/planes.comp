#version 460
#extension GL_GOOGLE_include_directive : require
// The plane of each slot: the mean of all that its surfaces say, both sides together. Nothing has been gathered yet.
#include "params.glsl"
#include "common/volume.glsl"
#include "common/voxels.glsl"
#include "common/planes.glsl"
#include "modules/merge.glsl"

layout(local_size_x = 128) in;

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= voxelCounter.count || axisOfSlot(slot) < 0) return;
    ivec3 cell = cellOfSlot(slot);
    vec3 normal = vec3(0.0);
    float offset = 0.0, count = 0.0;
    uint sides = 0, axis = uint(axisOfSlot(slot));
    for (uint side = 0; side < SIDES; side++) {
        uint base = sideBase(slot, side);
        float weight = float(voxelSlots.words[base + 3]);
        if (weight == 0.0) continue;
        vec3 c, n;
        mergedMean(base, c, n);
        normal += n * (side == 0 ? weight : -weight);
        offset += float(voxelSlots.words[base + SIDE_OFFSET]);
        count += weight;
        sides |= 1u << side;
    }
    VolumeMap map = volume.maps[cascadeOf(cell)];
    vec3 in_cells = normal * cellAxes(map, volumeToWorld(map, cellCentre(cell)));
    uint base = planeBase(voxelCounter.half_used, slot);
    keepPlane(base, in_cells, axis, offsetOfSum(offset, count), sides);
    for (uint k = 0; k < 2; k++) voxelPlanes.words[base + 1 + k] = voxelSlots.words[slot * SLOT_WORDS + SLOT_PARTS + k];
    for (uint side = 0; side < SIDES; side++) keepLight(gatheredWord(base, side), vec3(0.0), 0.0);
}
