// State of the rounds in which each voxel side gathers once. The short ones end with an extrapolation
// (bounce/extrapolate.comp).
#ifndef BOUNCE_ROUNDS_GLSL
#define BOUNCE_ROUNDS_GLSL
#include "history/rounds.glsl"

const uint SUM_GROUPS = 256;
const uint SUM_THREADS = 128;

struct BounceState {
    vec3 first; // light after the first round, summed over all sides that started then
    uint frame; // since the start
    vec3 light; // after the last round and its extrapolation, summed likewise
    uint still; // 1 if scene and volume have not changed since the start
};

layout(std430) buffer BounceRounds {
    BounceState state;
    uvec3 groups; // dispatch at the end of a short round
} bounceRounds;

layout(std430) readonly buffer LastRounds {
    BounceState state;
    uvec3 groups;
} lastRounds;

// Interleaving phase of a brick. Its voxels gather together, neighbouring bricks in different frames.
uint phaseOf(uvec3 brick, uint frames) {
    return (brick.x + 3u * brick.y + 5u * brick.z) % frames;
}

// Whether a side gathers: once in each round. Sides that appear later, for example on a moving object, gather
// at once.
bool isDue(uvec3 brick, uint updates, uint frame) {
    uint frames = updates < SHORT_ROUNDS ? shortRound() : uint(params.bounce_frames);
    if (updates == 0 && frame > frames) return true;
    return frame > 0 && phaseOf(brick, frames) == frame % frames;
}

#endif
