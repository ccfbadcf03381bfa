#version 460
#extension GL_GOOGLE_include_directive : require
// Prefix sum of the surfel counts of all chunks. Writes the total and the dispatch arguments of passes over
// surfels.
#include "params.glsl"
#include "volume/volume.glsl"
#include "voxels/voxels.glsl"
#define SUMS_CHUNKS
#include "voxels/chunks.glsl"

void main() {
    uint chunks = voxelCounter.chunk_groups.x, thread = gl_LocalInvocationIndex,
        share = (chunks + CHUNK_THREADS - 1) / CHUNK_THREADS;
    uint first = min(thread * share, chunks), end = min(first + share, chunks), share_sum = 0;
    for (uint i = first; i < end; i++) share_sum += voxelChunks.surfels[i];
    uint sum = inclusiveSum(share_sum), before = sum - share_sum;
    for (uint i = first; i < end; i++) {
        voxelStarts.surfels[i] = before;
        before += voxelChunks.surfels[i];
    }
    if (thread < CHUNK_THREADS - 1) return;
    uint count = min(sum, uint(params.voxel_capacity)),
        fragments = min(voxelCounter.fragments, voxelFragments.list.length());
    voxelCounter.count = count;
    voxelCounter.overflow = voxelCounter.fragments - fragments;
    voxelCounter.list_groups = uvec3((count + 127) / 128, 1, 1);
    voxelCounter.side_groups = uvec3(min((count * SIDES + 127) / 128, 65535u), 1, 1);
}
