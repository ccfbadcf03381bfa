#version 460
#extension GL_GOOGLE_include_directive : require
// The second bounce alone: each side of a voxel gathers what injection has put into the others, this frame. Nothing is kept,
// so nothing is late.
#include "params.glsl"
#include "modules/bounce_trace/rays.glsl"
#include "cones/near.glsl"
#include "bounce/gather.glsl"

layout(local_size_x = 128) in;

void main() {
    for (uint i = gl_GlobalInvocationID.x; i < voxelCounter.count * SIDES; i += gl_NumWorkGroups.x * 128) {
        uint slot = i / SIDES, side = i % SIDES;
        if (axisOfSlot(slot) < 0) continue;
        ivec3 cell = cellOfSlot(slot);
        uint base = planeBase(slot);
        VolumeMap map = volume.maps[cascadeOf(cell)];
        Side s = sideOfSlot(slot, side);
        if (s.normal == vec3(0.0)) continue;
        vec3 p = slotPosition(map, cell, base, side, uint(axisOfSlot(slot)));
        sideGathered.list[sideNumber(slot, side)] = packLight(gatherAt(p, s.normal, emits(slot, side), patternOf(uvec3(cell)), 0, 1), 1.0);
    }
}
