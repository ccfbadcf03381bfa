// Loop over all fragments. Consecutive ones mostly hit the same voxel. Neighbouring threads therefore take
// fragments that are far apart in the list, so that their atomics do not contend.
#ifndef FRAGMENT_SHARES_GLSL
#define FRAGMENT_SHARES_GLSL
#include "voxels/voxels.glsl"

const uint SHARES = 1u << 16;

uint fragmentCount() {
    return min(voxelCounter.fragments, voxelFragments.list.length());
}

// Steps of the loop, and the fragment of a step: beyond the list for some.
uint shareSteps() {
    return (fragmentCount() + SHARES - 1) / SHARES * SHARES;
}

uint fragmentOfStep(uint step) {
    return step % SHARES * (shareSteps() / SHARES) + step / SHARES;
}

#endif
