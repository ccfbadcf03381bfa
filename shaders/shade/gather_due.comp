#version 460
#extension GL_GOOGLE_include_directive : require
// The pixels of the lattice whose turn it is. Groups of threads have one pixel of each of 8x4 blocks of 8x8 pixels, the same one: their rays go the
// same ways, which caches and branches like.
#include "params.glsl"
#include "shade/turns.glsl"
const uint GATHER_THREADS = 4;
#include "shade/gather_shared.glsl"

void main() {
    uint lane = gl_LocalInvocationID.x, number = firstDue() + gl_WorkGroupID.z;
    uvec2 block = gl_WorkGroupID.xy * uvec2(8, 4) + uvec2(lane & 7u, lane >> 3);
    gatherPixel(ivec2(block * 8u + pixelOfNumber(number & 63u)), isOfLattice(number) && isDue(number), params.pixel_cones, params.pixel_cones, 0.0);
}
