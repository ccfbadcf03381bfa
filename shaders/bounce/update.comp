#version 460
#extension GL_GOOGLE_include_directive : require
// Reprojects the gathered light of voxel sides from the last frame, and queues the sides that gather again.
#include "params.glsl"
#include "bounce/reproject.glsl"
#include "bounce/gathered.glsl"
#include "bounce/rounds.glsl"
#define QUEUE_WRITES
#include "bounce/queue.glsl"
#include "bounce/placed.glsl"

layout(local_size_x = 128) in;

shared uint queued_here;
shared uint first;

// Largest move of a cascade in this frame, relative to its edge.
float moved() {
    float most = 0.0;
    for (int k = 0; k < CASCADE_COUNT; k++) {
        vec3 by = abs(placed.maps[k].minimum - volume.maps[k].minimum) / placed.maps[k].size;
        by = max(by, abs(placed.maps[k].eye - volume.maps[k].eye) / placed.maps[k].size);
        most = max(most, max(by.x, max(by.y, by.z)));
    }
    return most;
}

// Starts again when all or most sides are new: rounds then spread their gathering over frames.
BounceState nextState(bool has_history) {
    BounceState next = lastRounds.state;
    float move = has_history ? moved() : 1.0;
    if (move > 0.5) return BounceState(vec3(0.0), 0, vec3(0.0), 1);
    next.frame++;
    if (move > 0.0 || camera.still_frames < next.frame) next.still = 0;
    return next;
}

// Stores a side's history and returns whether the side gathers.
bool updateHistory(uint surfel, uint side, bool has_history, uint frame) {
    if (surfel >= voxelCounter.count || axisOfSurfel(surfel) < 0) return false;
    uint index = sideIndex(surfel, side);
    ivec3 cell = cellOfSurfel(surfel);
    int cascade = cascadeOf(cell);
    vec3 p = volumeToWorld(placed.maps[cascade], cellCentre(cell));
    uvec2 last = has_history ? reprojected(p, cascade, uint(axisOfSurfel(surfel)), side) : uvec2(0);
    SideLight light = sideLightOf(last);
    light.updates = min(light.updates, mostUpdates());
    sideGathered.list[index] = packSideLight(light);
    bool complete = light.updates > SHORT_ROUNDS && light.updates == mostUpdates();
    return !complete && isDue(uvec3(cell) >> 2, light.updates, frame);
}

// Appends the sides that are due to the queue. All threads of a group must call it.
void enqueue(bool due, uint i) {
    uint offset = 0;
    if (gl_LocalInvocationIndex == 0) queued_here = 0;
    barrier();
    if (due) offset = atomicAdd(queued_here, 1);
    barrier();
    if (gl_LocalInvocationIndex == 0 && queued_here > 0) first = reserve(queued_here);
    barrier();
    if (due) bounceQueue.items[first + offset] = i;
}

void main() {
    bool has_history = volume.signature == placed.signature;
    BounceState state = nextState(has_history);
    if (gl_GlobalInvocationID.x == 0) {
        bool ends = state.frame % shortRound() == 0 && state.frame > 0
            && state.frame <= SHORT_ROUNDS * shortRound();
        bounceRounds.state = state;
        bounceRounds.groups = uvec3(ends && state.still != 0 ? SUM_GROUPS : 0, 1, 1);
    }
    uint count = voxelCounter.count * SIDES, stride = gl_NumWorkGroups.x * 128;
    for (uint start = gl_WorkGroupID.x * 128; start < count; start += stride) {
        uint i = start + gl_LocalInvocationIndex;
        bool due = updateHistory(i / SIDES, i % SIDES, has_history, state.frame);
        enqueue(due, i);
    }
}
