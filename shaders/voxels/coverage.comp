#version 460
#extension GL_GOOGLE_include_directive : require
// Coverage of each fragment, merged into the coverage mask and the front layer of its side. The merge comes
// after, because it leaves out what front layers hide. Replaces the fragment's cell by its side, and its
// triangle by its coverage.
#include "params.glsl"
#include "volume/volume.glsl"
#include "voxels/bricks.glsl"
#include "surfels/surfels.glsl"
#include "voxels/fragment_coverage.glsl"
#include "voxels/layers.glsl"
#include "voxels/shares.glsl"

layout(local_size_x = 128) in;

// Merges a surface into the front layer of each quarter. Most sides have one surface, and the loop runs once.
void mergeFrontLayer(uint word, uint side, Layer layer) {
    uint mine = 0;
    for (uint i = 0; i < 4; i++)
        if (layer.covered[i] > 0) mine |= packFrontLayer(layer.offset, side, layer.covered[i]) << 8 * i;
    uint found = surfelData(word);
    for (;;) {
        uint seen = atomicCompSwap(surfels.quads[word >> 2][word & 3u], found, frontOf(found, mine));
        if (seen == found) return;
        found = seen;
    }
}

Layer mergedLayer(uint i) {
    ivec3 stored = unpackCell(voxelFragments.list[i].x);
    uint found = foundAtStored(stored), direction = voxelFragments.list[i].z;
    if (found == 0) {
        atomicAdd(voxelCounter.overflow, 1);
        return layerOf(Coverage(uvec2(0), 0, 0.0));
    }
    vec3 normal = unpackDirection(direction);
    uint axis = axisOf(normal), side = sideOf(normal, axis), surfel = surfelOf(found, axis);
    uint base = surfelBase(surfel);
    voxelFragments.list[i].x = sideIndex(surfel, side);
    uvec2 triangle = voxelTriangles.list[i];
    Coverage coverage = fragmentCoverage(triangle, stored, axis, unpackOffset(direction));
    Layer layer = layerOf(coverage);
    if (layer.weight == 0 || SIDES == 1) return layer; // front layers and masks need two sides
    // Points and samples have no exact offset.
    if (triangle != NO_TRIANGLE) mergeFrontLayer(frontLayerWord(base, side), side, layer);
    for (uint k = 0; k < 2; k++) {
        uint word = coverageMaskWord(base, side) + k;
        if ((surfelData(word) & coverage.mask[k]) != coverage.mask[k])
            atomicOr(surfels.quads[word >> 2][word & 3u], coverage.mask[k]);
    }
    return layer;
}

void main() {
    uint count = fragmentCount(), share = shareOf(count), stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint step = gl_GlobalInvocationID.x; step < share * SHARES; step += stride) {
        uint i = fragmentOfStep(step, share);
        if (i < count) voxelTriangles.list[i] = packLayer(mergedLayer(i));
    }
}
