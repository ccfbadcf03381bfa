// The list of surfels. A surfel is the surface of a cell along one axis, with up to two sides
// (modules/sides). Fragments add to its sums. These are integers: order does not matter, and runs agree to
// the bit. voxels/bricks.glsl finds the surfels of a cell.
#ifndef VOXELS_GLSL
#define VOXELS_GLSL

#include "voxels/packing.glsl"
#include "voxels/radiance.glsl"
#include "modules/sides.glsl"

// Sums over a side's fragments, weighted by area: colour 0-2, weight 3, normal 4-6, emission 7-9, offset 10.
const uint SIDE_WORDS = 11;
const uint SIDE_OFFSET = 10;
const uint SURFEL_CELL = SIDES * SIDE_WORDS; // cell, and axis + 1 from bit 30; 0: no surfel
const uint SURFEL_SUM_WORDS = SURFEL_CELL + 1;

// Fixed-point scales, multiplied by weights. Colour and normal overflow only if a cell is covered a thousand
// times, emission only if it is covered 2.6e5 / radiance times.
const float COLOR_SCALE = 4095.0;
const float NORMAL_SCALE = 2047.0;
const float EMISSION_SCALE = 16.0;
const float EMISSION_MAX = 1024.0;

layout(std430) buffer SurfelSums { uint words[]; } surfelSums;
layout(std430) buffer VoxelCounter {
    uint overflow; // lost fragments: the list of surfels, bricks or fragments was full
    uint count; // surfels in the list
    uint fragments; // requested, also beyond the capacity
    uint bricks; // with a surface
    uint pieces; // queued triangle pieces
    uint touched; // queued bricks that pieces touch
    uvec3 fragment_groups; // indirect dispatch over the fragments
    uvec3 chunk_groups; // over brick words, one chunk per group (voxels/chunks.glsl)
    uvec3 word_groups; // over brick words, 4 per group
    uvec3 list_groups; // over the surfels
    uvec3 side_groups; // over the sides of surfels
} voxelCounter;

// Fragments in no particular order: cell, colour, normal and offset, emission. voxelTriangles has each
// fragment's triangle: its draw, and its first position in `indices`. After coverage.comp it has the coverage
// (voxels/layers.glsl), and voxelFragments the index of the side instead of the cell.
layout(std430) buffer VoxelFragments { uvec4 list[]; } voxelFragments;
layout(std430) buffer VoxelTriangles { uvec2 list[]; } voxelTriangles;

const uvec2 NO_TRIANGLE = uvec2(0xffffffffu); // the fragment covers the whole cell

// x, y: below 512; z: below 512 for each cascade.
uint packCell(ivec3 c) {
    return uint(c.x | c.y << 9 | c.z << 18);
}

ivec3 unpackCell(uint word) {
    return ivec3(word & 511u, word >> 9 & 511u, word >> 18 & 4095u);
}

ivec3 cellOfSurfel(uint surfel) {
    return unpackCell(surfelSums.words[surfel * SURFEL_SUM_WORDS + SURFEL_CELL]);
}

// Axis that a surfel's surfaces face; -1 if the surfel is not in use.
int axisOfSurfel(uint surfel) {
    return int(surfelSums.words[surfel * SURFEL_SUM_WORDS + SURFEL_CELL] >> 30) - 1;
}

// Decode a lookup: the cell's surfel count, its first surfel, and the surfel of an axis.
uint surfelCount(uint texel) {
    return bitCount(texel & 7u);
}

uint firstSurfel(uint texel) {
    return texel >> 3;
}

uint surfelOf(uint texel, uint axis) {
    return firstSurfel(texel) + bitCount(texel & ((1u << axis) - 1u));
}

// First word of a side.
uint sideBase(uint surfel, uint side) {
    return surfel * SURFEL_SUM_WORDS + side * SIDE_WORDS;
}

vec3 meanEmission(uint base) {
    float weight = float(max(surfelSums.words[base + 3], 1u));
    return vec3(surfelSums.words[base + 7], surfelSums.words[base + 8], surfelSums.words[base + 9])
        / (EMISSION_SCALE * weight);
}

#endif
