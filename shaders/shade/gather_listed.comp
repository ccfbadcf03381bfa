#version 460
#extension GL_GOOGLE_include_directive : require
// Pixels that gather although it is not their turn.
#include "params.glsl"
#include "shade/kept.glsl"
#include "shade/gather_shared.glsl"

void main() {
    uint count = gatherCounter.count;
    for (uint start = gl_WorkGroupID.x * GATHER_PIXELS; start < count; start += gl_NumWorkGroups.x * GATHER_PIXELS) {
        uint i = start + gl_LocalInvocationID.x, word = i < count ? gatherList.pixels[i] : 0, how = word >> 30;
        ivec2 pixel = ivec2(word & 0x7fffu, word >> 15 & 0x7fffu);
        int rays = how == GATHER_ALL ? params.pixel_cones : how == GATHER_FEW ? min(params.pixel_cones, int(GATHER_THREADS)) : 0;
        float age = 0.0;
        ivec2 at;
        if (i < count && how == GATHER_MIRRORED && seenBefore(pixel, gbufferAt(pixel), at)) age = ageAt(at);
        gatherPixel(pixel, i < count, rays, age);
        barrier();
    }
}
