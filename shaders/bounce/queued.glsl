// Gathers the light of queued voxel sides with a few rays or narrow cones, several threads per side.
// Neighbouring cells use other directions. Injection reflects this light, so each frame adds a bounce. All
// hits read last frame's data, including `volume`; `placed` is the current volume.
#include "params.glsl"
#include "voxels/voxels.glsl"
#include "volume/volume.glsl"

layout(std430) readonly buffer LastSurfels { uvec4 quads[]; } lastSurfels;
layout(std430) readonly buffer LastRadiance { uvec2 list[]; } lastRadiance;
layout(std430) readonly buffer LastBricks { uvec4 words[]; } lastBricks;
layout(std430) readonly buffer LastBlocks { uvec4 list[]; } lastBlocks;

#define HIT_SURFELS lastSurfels
#define HIT_RADIANCE lastRadiance
#define HIT_BRICKS lastBricks
#define HIT_BLOCKS lastBlocks
#include "modules/bounce_trace.glsl"
#include "surfels/trace.glsl"
#include "bounce/gather.glsl"
#include "bounce/queue.glsl"
#include "bounce/placed.glsl"
#include "history/rounds.glsl"
#include "bounce/residual.glsl"

const uint BOUNCE_THREADS = 4;

layout(local_size_x = BOUNCE_SIDES, local_size_y = BOUNCE_THREADS) in;

shared vec3 shared_light[BOUNCE_THREADS][BOUNCE_SIDES];

vec3 gatheredShare(uint surfel, uint side, int part) {
    Side s = sideOfSurfel(surfel, side);
    if (s.normal == vec3(0.0)) return vec3(0.0);
    ivec3 cell = cellOfSurfel(surfel);
    uint axis = uint(axisOfSurfel(surfel));
    VolumeMap map = placed.maps[cascadeOf(cell)];
    vec3 p = surfelPosition(map, cell, surfelBase(surfel), side, axis);
    SideShifts shifts = shiftsOf(map, cell, axis, side, bounceRound());
    return gatherAt(p, s.normal, emits(surfel, side), shifts, part, int(BOUNCE_THREADS));
}

void main() {
    uint lane = gl_LocalInvocationID.x, part = gl_LocalInvocationID.y, count = bounceCounter.count;
    uint stride = gl_NumWorkGroups.x * BOUNCE_SIDES;
    for (uint start = gl_WorkGroupID.x * BOUNCE_SIDES; start < count; start += stride) {
        vec3 light = vec3(0.0);
        uint index = 0;
        if (start + lane < count) {
            index = bounceQueue.items[start + lane];
            light = gatheredShare(index / SIDES, index % SIDES, int(part));
        }
        shared_light[part][lane] = light;
        barrier();
        bool stores = part == 0 && start + lane < count;
        vec3 begun = vec3(0.0);
        float updates = 0.0;
        if (stores) {
            for (uint k = 1; k < BOUNCE_THREADS; k++) light += shared_light[k][lane];
            uvec2 last = sideGathered.list[index];
            updates = numberOf(last);
            begun = lightOf(last);
            float averaged = max(updates - float(params.bounce_frames), 0.0);
            light = mix(begun, light, weightOfRound(uint(averaged)));
            sideGathered.list[index] = packLight(light, updates);
        }
        if (inShortRound())
            recordResidual(stores, index, light, begun, updates >= float(params.bounce_frames));
        barrier();
    }
}
