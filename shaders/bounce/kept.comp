#version 460
#extension GL_GOOGLE_include_directive : require
// What the sides of voxels keep of the light that they have gathered; those whose turn it is are listed. Last frame's light is found
// by its place: `volume` and bricks are last frame's, `placed` says where voxels lie now.
#include "params.glsl"
#include "common/scene.glsl"
#include "common/sides.glsl"
#include "common/planes.glsl"
#include "common/bricks.glsl"
#include "bounce/list.glsl"
#include "bounce/placed.glsl"

layout(local_size_x = 128) in;

layout(std430) readonly buffer LastGathered { uvec2 list[]; } lastGathered;

shared uint listed_here;
shared uint first;

// Last frame's light of what lies at p and faces along an axis; gathered 0 times where there was nothing.
uvec2 gatheredBefore(vec3 p, int cascade, uint axis, uint side) {
    vec3 u = worldToVolume(volume.maps[cascade], p);
    if (!inVolume(u)) return uvec2(0);
    ivec3 cell = min(ivec3(u * float(params.voxel_dim)), ivec3(params.voxel_dim - 1));
    uint found = foundAt(cell, cascade);
    if ((found >> axis & 1u) == 0) return uvec2(0);
    return lastGathered.list[sideNumber(slotOf(found, axis), side)];
}

// Bricks side by side have other turns.
uint turnOf(uvec3 brick) {
    return brick.x + 3u * brick.y + 5u * brick.z;
}

// Whether a side gathers. A part of the voxels each frame, and the others keep what they have; but all of them in every frame at
// first, so that light goes round before the first pictures are seen. By bricks: neighbours gather together.
bool gathers(uint slot, uint side, bool was_lit) {
    if (slot >= voxelCounter.count || axisOfSlot(slot) < 0) return false;
    uint number = sideNumber(slot, side), frames = uint(params.bounce_frames);
    if (!was_lit) {
        sideGathered.list[number] = uvec2(0);
        return false;
    }
    ivec3 cell = cellOfSlot(slot);
    int cascade = cascadeOf(cell);
    uvec2 last = gatheredBefore(volumeToWorld(placed.maps[cascade], cellCentre(cell)), cascade, uint(axisOfSlot(slot)), side);
    float times = timesOf(last);
    bool keeps = times >= float(frames) && turnOf(uvec3(cell) >> 2) % frames != camera.frame % frames;
    sideGathered.list[number] = keeps ? last : packLight(vec3(0.0), min(times + 1.0, float(frames)));
    return !keeps;
}

void main() {
    bool was_lit = volume.signature == placed.signature;
    for (uint start = gl_WorkGroupID.x * 128; start < voxelCounter.count * SIDES; start += gl_NumWorkGroups.x * 128) {
        uint i = start + gl_LocalInvocationIndex, place = 0;
        if (gl_LocalInvocationIndex == 0) listed_here = 0;
        barrier();
        bool listed = gathers(i / SIDES, i % SIDES, was_lit);
        if (listed) place = atomicAdd(listed_here, 1);
        barrier();
        if (gl_LocalInvocationIndex == 0 && listed_here > 0) {
            first = atomicAdd(bounceCounter.count, listed_here);
            atomicMax(bounceCounter.groups.x, min((first + listed_here + BOUNCE_SIDES - 1) / BOUNCE_SIDES, 65535u));
        }
        barrier();
        if (listed) bounceList.sides[first + place] = i;
    }
}
