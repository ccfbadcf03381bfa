#version 460
#extension GL_GOOGLE_include_directive : require
// Pixels that gather for themselves, or although it is not their turn.
#include "params.glsl"
#define READS_AGE
// More than in turns: these are few, and the slowest ray of a thread is what all wait for.
const uint GATHER_THREADS = 8;
#include "shade/kept.glsl"
#include "shade/gather_shared.glsl"

void main() {
    uint count = gatherCounter.count;
    for (uint start = gl_WorkGroupID.x * GATHER_PIXELS; start < count; start += gl_NumWorkGroups.x * GATHER_PIXELS) {
        uint i = start + gl_LocalInvocationID.x, word = i < count ? gatherList.pixels[i] : 0, how = word >> 30;
        ivec2 pixel = ivec2(word & 0x7fffu, word >> 15 & 0x7fffu);
        int few = min(params.pixel_cones, FEW_RAYS);
        int rays = how == GATHER_ALL ? params.pixel_cones : how == GATHER_FEW ? few : 0;
        int lobe = how == GATHER_LOBE ? params.pixel_cones : rays;
        float age = i < count && how == GATHER_MIRRORED ? imageLoad(gatheredSpecular, pixel).a : 0.0;
        gatherPixel(pixel, i < count, rays, lobe, age);
        barrier();
    }
}
