#version 460
#extension GL_GOOGLE_include_directive : require
// Reprojects the gathered light of voxel sides from the last frame, and queues the sides that gather again.
#include "params.glsl"
#include "bounce/reproject.glsl"
#define QUEUE_WRITES
#include "bounce/queue.glsl"
#include "bounce/placed.glsl"
#include "bounce/acceleration.glsl"

layout(local_size_x = 128) in;

layout(std430) readonly buffer LastResiduals { RoundSums rounds[2]; } lastResiduals;
layout(std430) writeonly buffer RoundResiduals { RoundSums rounds[2]; } roundResiduals;
layout(std430) readonly buffer LastChanges { SideChange list[]; } lastChanges;
layout(std430) writeonly buffer SideChanges { SideChange list[]; } sideChanges;

shared uint queued_here;
shared uint first;

// Whether a brick's voxels gather: once in a round, and in the same order in all short rounds. Neighbouring
// bricks gather in different frames.
bool isInPhase(uvec3 brick) {
    uint phase = camera.frame;
    if (inShortRound()) {
        if (frameOfShortRound() < lightDelay()) return false;
        phase = frameOfShortRound() - lightDelay();
    }
    uint frames = bounceRoundFrames();
    return (brick.x + 3u * brick.y + 5u * brick.z) % frames == phase % frames;
}

// Keeps the sums of the present and the last round.
void keepSums(uint thread) {
    if (thread >= 2) return;
    RoundSums sums = lastResiduals.rounds[thread];
    if (thread == (shortRoundNumber() & 1u) && frameOfShortRound() == 0) {
        for (int c = 0; c < 3; c++) sums.largest[c] = 0u;
        for (int k = 0; k < 6; k++) sums.products[k] = uint[2](0u, 0u);
    }
    roundResiduals.rounds[thread] = sums;
}

// Keeps a side's change and returns how far a round that begins starts below the side's light.
vec3 keepChange(uint from, uint to) {
    uint round = shortRoundNumber();
    SideChange change = NO_CHANGE;
    if (from != ~0u) change = lastChanges.list[from];
    sideChanges.list[to] = change;
    if (round == 0 || frameOfShortRound() != 0) return vec3(0.0);
    return stepFrom(lastResiduals.rounds[1 - (round & 1u)]) * advanceOf(change);
}

// Stores a side's history and returns whether the side gathers: in its phase, and in every frame until it has
// gathered once per phase, so that the first frames have light.
bool updateHistory(uint surfel, uint side, bool has_history) {
    if (surfel >= voxelCounter.count || axisOfSurfel(surfel) < 0) return false;
    uint index = sideIndex(surfel, side), phases = uint(params.bounce_frames);
    if (!has_history) {
        sideGathered.list[index] = uvec2(0);
        sideChanges.list[index] = NO_CHANGE;
        return false;
    }
    ivec3 cell = cellOfSurfel(surfel);
    int cascade = cascadeOf(cell);
    vec3 p = volumeToWorld(placed.maps[cascade], cellCentre(cell));
    uint from = reprojected(p, cascade, uint(axisOfSurfel(surfel)), side);
    uvec2 last = from == ~0u ? uvec2(0) : lastGathered.list[from];
    vec3 light = lightOf(last);
    if (inShortRound()) light = max(light - keepChange(from, index), 0.0);
    // Beyond `phases`, updates count the rounds that the mean has taken since its first.
    bool averages = bounceRound() > 0;
    uint most = phases + (averages ? uint(params.accumulation_rounds) - 1 : 0);
    uint updates = min(uint(numberOf(last)), most);
    bool complete = averages && updates == most;
    bool due = updates < phases || !complete && isInPhase(uvec3(cell) >> 2);
    sideGathered.list[index] = packLight(light, float(due ? min(updates + 1, most) : updates));
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
    if (gl_WorkGroupID.x == 0 && inShortRound()) keepSums(gl_LocalInvocationIndex);
    bool has_history = volume.signature == placed.signature;
    uint count = voxelCounter.count * SIDES, stride = gl_NumWorkGroups.x * 128;
    for (uint start = gl_WorkGroupID.x * 128; start < count; start += stride) {
        uint i = start + gl_LocalInvocationIndex;
        bool due = updateHistory(i / SIDES, i % SIDES, has_history);
        enqueue(due, i);
    }
}
