#version 460
#extension GL_GOOGLE_include_directive : require
// The planes of each slot: the mean of all that the surfaces of a side say. Which parts they cover is merged already.
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
    uint axis = uint(axisOfSlot(slot)), base = planeBase(slot);
    VolumeMap map = volume.maps[cascadeOf(cell)];
    mat3 axes = cellAxes(map, volumeToWorld(map, cellCentre(cell)));
    uint own = 0;
    for (uint side = 0; side < SIDES; side++) own |= uint(voxelSlots.words[sideBase(slot, side) + 3] != 0) << side;
    for (uint side = 0; side < SIDES; side++) {
        uint seen = SIDES == 1 || (own >> side & 1u) != 0 ? side : 1 - side, sums = sideBase(slot, seen);
        vec3 color, normal;
        mergedMean(sums, color, normal);
        float offset = offsetOfSum(float(voxelSlots.words[sums + SIDE_OFFSET]), float(voxelSlots.words[sums + 3]));
        keepPlane(planeWord(base, side), (seen == 0 ? normal : -normal) * axes, axis, offset, own);
        for (uint k = 0; seen != side && k < 2; k++) keepData(partsWord(base, side) + k, planeData(partsWord(base, seen) + k));
    }
}
