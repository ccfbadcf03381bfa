// Queue of the voxel sides that gather in this frame: surfel * SIDES + side.
const uint BOUNCE_SIDES = 32; // per group
#define QUEUE_LIST bounceQueue
#define QUEUE_COUNTER bounceCounter
#define QUEUE_GROUP BOUNCE_SIDES
#include "common/queue.glsl"
