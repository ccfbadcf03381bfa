// Loop over all fragments. Consecutive ones mostly hit the same voxel. Neighbouring threads therefore take
// fragments that are far apart in the list, so that their atomics do not contend.
#ifndef FRAGMENT_SHARES_GLSL
#define FRAGMENT_SHARES_GLSL
#include "voxels/voxels.glsl"

const uint SHARES = 1u << 16;

uint fragmentCount() {
    return min(voxelCounter.fragments, voxelFragments.list.length());
}

// Fragments of a share. The loop has SHARES times as many steps.
uint shareOf(uint count) {
    return (count + SHARES - 1) / SHARES;
}

// Fragment of a step; for some steps beyond the list.
uint fragmentOfStep(uint step, uint share) {
    return step % SHARES * share + step / SHARES;
}

#endif
