// Sides of voxels that gather in a frame.
layout(std430) buffer BounceList { uint sides[]; } bounceList; // slot * SIDES + side
layout(std430) buffer BounceCounter {
    uint count;
    uvec3 groups; // indirect dispatch over the list
} bounceCounter;

const uint BOUNCE_SIDES = 32; // of a group
