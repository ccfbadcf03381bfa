#version 460
#extension GL_GOOGLE_include_directive : require
// Restores the sums of scrolled surfels, once their cells have surfels again.
#include "params.glsl"
#include "volume/volume.glsl"
#include "voxels/bricks.glsl"
#include "voxels/scrolled.glsl"

layout(local_size_x = 128) in;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= scrolledCounter.count) return;
    uint first = i * SCROLLED_WORDS, packed = scrolledSurfels.words[first + SURFEL_CELL],
        found = foundAtStored(unpackCell(packed));
    if (found == 0) { // causes a warning, and the next frame voxelizes everything
        atomicAdd(voxelCounter.overflow, 1);
        return;
    }
    uint surfel = surfelOf(found, (packed >> 30) - 1);
    for (uint word = 0; word < SURFEL_CELL; word++)
        surfelSums.words[surfel * SURFEL_SUM_WORDS + word] = scrolledSurfels.words[first + word];
    for (uint word = SURFEL_MASKS; word < SURFEL_WORDS; word++)
        storeSurfelData(surfelBase(surfel) + word,
            scrolledSurfels.words[first + SCROLLED_MASKS + word - SURFEL_MASKS]);
}
