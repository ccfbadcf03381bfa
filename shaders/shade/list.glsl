// Pixels that gather in this frame.
layout(std430) buffer GatherList { uint pixels[]; } gatherList; // the pixel, and above it how
layout(std430) buffer GatherCounter {
    uint count;
    uvec3 groups; // indirect dispatch over the list
} gatherCounter;
