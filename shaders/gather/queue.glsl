// Queue of the pixels that gather in this frame.
#ifndef SHADE_QUEUE_GLSL
#define SHADE_QUEUE_GLSL

const uint GATHER_PIXELS = 32; // per group
#define QUEUE_LIST gatherQueue
#define QUEUE_COUNTER gatherCounter
#define QUEUE_GROUP GATHER_PIXELS
#include "common/queue.glsl"

// Gathering modes of a pixel.
const uint GATHER_FEW = 0; // FEW_RAYS: a disoccluded pixel before its phase
const uint GATHER_ALL = 1; // all rays: the pixel is due
const uint GATHER_MIRRORED = 2; // only its reflection
const uint GATHER_NOTHING = 3; // not queued
const int FEW_RAYS = 4;

uint packQueued(uvec2 pixel, uint mode) {
    return pixel.x | pixel.y << 15 | mode << 30;
}

ivec2 queuedPixel(uint word) {
    return ivec2(word & 0x7fffu, word >> 15 & 0x7fffu);
}

uint queuedMode(uint word) {
    return word >> 30;
}

#endif
