// Compacts the pixels that gather into a queue. A group sorts the pixels of a region by mode and index in
// their 8x8 tile (counting sort in shared memory), so that neighbouring threads trace similar rays.
#ifndef HISTORY_ENQUEUE_GLSL
#define HISTORY_ENQUEUE_GLSL
#define QUEUE_WRITES
#include "gather/queue.glsl"

const ivec2 REGION = ivec2(64, 32);
const uint REGION_PIXELS = REGION.x * REGION.y;
const uint REGION_THREADS = 256;
const uint KINDS = 256; // GATHER_ mode and index in the 8x8 tile: one per thread
#define SCAN_THREADS KINDS
#include "common/scan.glsl"

layout(local_size_x = REGION_THREADS) in;

const uint NOT_QUEUED = 0xffffffffu;

shared uint region_pixels[REGION_PIXELS]; // bits 0-7: kind; from bit 8: rank in the kind
shared uint kind_starts[KINDS]; // count of each kind, then its first position
shared uint region_start; // in the queue

ivec2 regionPixel(uint i) {
    return REGION * ivec2(gl_WorkGroupID.xy) + ivec2(i % REGION.x, i / REGION.x);
}

// Replaces the counts of kinds with their prefix sum, and reserves room in the queue.
void reserveRegion() {
    uint kind = gl_LocalInvocationIndex, count = kind_starts[kind], sum = inclusiveSum(count);
    kind_starts[kind] = sum - count;
    if (kind == KINDS - 1 && sum > 0) region_start = reserve(sum);
}

void beginRegion() {
    kind_starts[gl_LocalInvocationIndex] = 0;
    barrier();
}

// Queues pixel i of the region. `mode`: one of the GATHER_ constants. index: in the 8x8 tile.
void enqueue(uint i, uint mode, uint index) {
    region_pixels[i] = NOT_QUEUED;
    if (mode == GATHER_NOTHING) return;
    uint kind = mode * 64 + index;
    region_pixels[i] = kind | atomicAdd(kind_starts[kind], 1) << 8;
}

void endRegion() {
    barrier();
    reserveRegion();
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < REGION_PIXELS; i += REGION_THREADS) {
        uint word = region_pixels[i], kind = word & 255;
        if (word == NOT_QUEUED) continue;
        uint item = region_start + kind_starts[kind] + (word >> 8);
        gatherQueue.items[item] = packQueued(uvec2(regionPixel(i)), kind >> 6);
    }
}

#endif
