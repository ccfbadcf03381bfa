// Work queue: a list, and a counter that holds the arguments of an indirect dispatch over the list. Clearing
// the counter empties the queue. The including file defines QUEUE_LIST and QUEUE_COUNTER (buffer names) and
// QUEUE_GROUP (items per group of the dispatch). Shaders that add items also define QUEUE_WRITES.
#ifndef QUEUE_GLSL
#define QUEUE_GLSL

layout(std430) buffer QueueList { uint items[]; } QUEUE_LIST;
layout(std430) buffer QueueCounter {
    uint count;
    uvec3 groups; // of the indirect dispatch
} QUEUE_COUNTER;

#ifdef QUEUE_WRITES
// Reserves space for items, at least one, and returns the index of the first.
uint reserve(uint count) {
    uint first = atomicAdd(QUEUE_COUNTER.count, count);
    atomicMax(QUEUE_COUNTER.groups.x, min((first + count + QUEUE_GROUP - 1) / QUEUE_GROUP, 65535u));
    QUEUE_COUNTER.groups.y = 1;
    QUEUE_COUNTER.groups.z = 1;
    return first;
}
#endif

#endif
