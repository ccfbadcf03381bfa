#version 460
#extension GL_GOOGLE_include_directive : require
// Reprojects the gathered light of voxel sides from the last frame, and queues the sides that gather again.
#include "params.glsl"
#include "bounce/reproject.glsl"
#define QUEUE_WRITES
#include "bounce/queue.glsl"
#include "bounce/placed.glsl"
#include "history/rounds.glsl"

layout(local_size_x = 128) in;

shared uint queued_here;
shared uint first;

// Whether a brick's voxels gather: once in a round. Neighbouring bricks gather in different frames.
bool isInPhase(uvec3 brick) {
    uint frames = bounceRoundFrames();
    return (brick.x + 3u * brick.y + 5u * brick.z) % frames == camera.frame % frames;
}

// Stores a side's history and returns whether the side gathers: in its phase, and in every frame until it has
// gathered once per phase, so that the first frames have light.
bool updateHistory(uint surfel, uint side, bool has_history) {
    if (surfel >= voxelCounter.count || axisOfSurfel(surfel) < 0) return false;
    uint index = sideIndex(surfel, side), phases = uint(params.bounce_frames);
    if (!has_history) {
        sideGathered.list[index] = uvec2(0);
        return false;
    }
    ivec3 cell = cellOfSurfel(surfel);
    int cascade = cascadeOf(cell);
    vec3 p = volumeToWorld(placed.maps[cascade], cellCentre(cell));
    uvec2 last = reprojected(p, cascade, uint(axisOfSurfel(surfel)), side);
    // Beyond `phases`, updates count the rounds that the mean has taken since its first.
    bool averages = bounceRound() > 0;
    uint most = phases + (averages ? uint(params.accumulation_rounds) - 1 : 0);
    uint updates = min(uint(numberOf(last)), most);
    bool complete = averages && updates == most;
    bool due = updates < phases || !complete && isInPhase(uvec3(cell) >> 2);
    sideGathered.list[index] = packLight(lightOf(last), float(due ? min(updates + 1, most) : updates));
    return due;
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
    uint count = voxelCounter.count * SIDES, stride = gl_NumWorkGroups.x * 128;
    for (uint start = gl_WorkGroupID.x * 128; start < count; start += stride) {
        uint i = start + gl_LocalInvocationIndex;
        bool due = updateHistory(i / SIDES, i % SIDES, has_history);
        enqueue(due, i);
    }
}
