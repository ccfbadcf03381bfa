// Gathers the light of the queued voxel sides with a few rays or narrow cones, several threads a side.
// Neighbours take other directions. Injection reflects the light, so that each frame adds a bounce. All hits
// read the last frame's data, `volume` too; `placed` is the current volume.
#include "params.glsl"
#include "common/voxels.glsl"
#include "common/volume.glsl"

layout(std430) readonly buffer LastSurfels { uvec4 quads[]; } lastSurfels;
layout(std430) readonly buffer LastRadiance { uvec2 list[]; } lastRadiance;
layout(std430) readonly buffer LastBricks { uvec4 words[]; } lastBricks;
layout(std430) readonly buffer LastBlocks { uvec4 list[]; } lastBlocks;

#define MET_PLANES lastSurfels
#define MET_RADIANCE lastRadiance
#define MET_BRICKS lastBricks
#define MET_BLOCKS lastBlocks
#include "modules/bounce_trace.glsl"
#include "cones/near.glsl"
#include "bounce/gather.glsl"
#include "bounce/queue.glsl"
#include "bounce/placed.glsl"

const uint BOUNCE_THREADS = 4;

layout(local_size_x = BOUNCE_SIDES, local_size_y = BOUNCE_THREADS) in;

shared vec3 shared_light[BOUNCE_THREADS][BOUNCE_SIDES];

void main() {
    uint lane = gl_LocalInvocationID.x, part = gl_LocalInvocationID.y, count = bounceCounter.count;
    for (uint start = gl_WorkGroupID.x * BOUNCE_SIDES; start < count; start += gl_NumWorkGroups.x * BOUNCE_SIDES) {
        vec3 light = vec3(0.0);
        uint number = 0;
        if (start + lane < count) {
            uint i = bounceQueue.items[start + lane], surfel = i / SIDES, side = i % SIDES;
            ivec3 cell = cellOfSurfel(surfel);
            uint axis = uint(axisOfSurfel(surfel)), base = surfelBase(surfel);
            Side s = sideOfSurfel(surfel, side);
            number = sideNumber(surfel, side);
            if (s.normal != vec3(0.0))
                light = gatherAt(surfelPosition(placed.maps[cascadeOf(cell)], cell, base, side, axis), s.normal, emits(surfel, side), patternOf(uvec3(cell)), int(part), int(BOUNCE_THREADS));
        }
        shared_light[part][lane] = light;
        barrier();
        if (part == 0 && start + lane < count) {
            for (uint k = 1; k < BOUNCE_THREADS; k++) light += shared_light[k][lane];
            sideGathered.list[number] = packLight(light, timesOf(sideGathered.list[number]));
        }
        barrier();
    }
}
