#version 460
#extension GL_GOOGLE_include_directive : require
// Gives the kept surfels their sums back, once their cells have surfels again.
#include "params.glsl"
#include "volume/volume.glsl"
#include "voxels/bricks.glsl"
#include "voxels/kept.glsl"

layout(local_size_x = 128) in;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= keptCounter.count) return;
    uint first = i * KEPT_WORDS, packed = voxelKept.words[first + SURFEL_CELL], found = foundAtStored(unpackCell(packed));
    if (found == 0) { // told; and the next frame makes all anew
        atomicAdd(voxelCounter.overflow, 1);
        return;
    }
    uint surfel = surfelOf(found, (packed >> 30) - 1);
    for (uint word = 0; word < SURFEL_CELL; word++) surfelSums.words[surfel * SURFEL_SUM_WORDS + word] = voxelKept.words[first + word];
    for (uint word = SURFEL_MASKS; word < SURFEL_WORDS; word++) storeSurfelData(surfelBase(surfel) + word, voxelKept.words[first + KEPT_MASKS + word - SURFEL_MASKS]);
}
