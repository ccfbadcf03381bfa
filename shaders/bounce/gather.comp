#version 460
#extension GL_GOOGLE_include_directive : require
// Light that comes to the voxels from each other: every side of every voxel gathers it with a few rays or narrow cones, its
// neighbours in other directions. Injection reflects it, so that each frame adds a bounce. All that they meet is last frame's:
// `volume` says where its voxels lay, `placed` where they lie now.
#include "params.glsl"
#include "common/voxels.glsl"
#define LISTED_HALF (1 - voxelCounter.half_used)
#include "modules/bounce_trace.glsl"
#include "cones/near.glsl"
#include "bounce/gather.glsl"

layout(local_size_x = 128) in;

layout(std430) readonly buffer Placed { VolumeMap maps[MAX_CASCADES]; } placed;

// The word of last frame's light of what lies at p and faces along an axis; 0: there was nothing.
uint gatheredBefore(vec3 p, int cascade, uint axis, uint side) {
    vec3 u = worldToVolume(volume.maps[cascade], p);
    if (!inVolume(u)) return 0;
    ivec3 cell = min(ivec3(u * float(params.voxel_dim)), ivec3(params.voxel_dim - 1));
    uint found = texelFetch(voxelIndex, storedCell(cell, cascade), 0).r;
    if (found == CELL_FULL || (found >> axis & 1u) == 0) return 0;
    return gatheredWord(planeBase(LISTED_HALF, slotOf(found, axis)), side);
}

// Bricks side by side have other turns.
uint turnOf(uvec3 brick) {
    return brick.x + 3u * brick.y + 5u * brick.z;
}

void main() {
    uint i = gl_GlobalInvocationID.x, slot = i / SIDES, side = i % SIDES;
    if (slot >= voxelCounter.count || axisOfSlot(slot) < 0) return;
    if (volume.maps[0].size.x == 0.0 || !namesAll(LISTED_HALF)) return; // there was no light before
    ivec3 cell = cellOfSlot(slot);
    uint axis = uint(axisOfSlot(slot)), base = planeBase(voxelCounter.half_used, slot), pattern = patternOf(uvec3(cell));
    int cascade = cascadeOf(cell);
    VolumeMap map = placed.maps[cascade];

    // A part of the voxels each frame, and the others keep what they have; but all of them in every frame at first, so that light
    // goes round before the first pictures are seen. By bricks: threads beside each other gather together, or none of them.
    uint frames = uint(params.bounce_frames), before = gatheredBefore(volumeToWorld(map, cellCentre(cell)), cascade, axis, side);
    float times = before == 0 ? 0.0 : timesGathered(before);
    if (times >= float(frames) && turnOf(uvec3(cell) >> 2) % frames != camera.frame % frames) {
        keepLight(gatheredWord(base, side), lightWords(before), times);
        return;
    }
    Side s = sideOfSlot(slot, side);
    if (s.normal == vec3(0.0)) return;
    keepLight(gatheredWord(base, side), gatherAt(slotPosition(map, cell, base, side, axis), s.normal, pattern), min(times + 1.0, float(frames)));
}
