// The list of surfels. A surfel is the surface of a cell along one axis, with up to two sides
// (modules/sides). Fragments add to its sums. These are integers: order does not matter, and runs agree to
// the bit. voxels/bricks.glsl finds the surfels of a cell.
#ifndef VOXELS_GLSL
#define VOXELS_GLSL

#include "common/math.glsl"
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
// fragment's triangle: its draw, and its first position in `indices`.
layout(std430) buffer VoxelFragments { uvec4 list[]; } voxelFragments;
layout(std430) buffer VoxelTriangles { uvec2 list[]; } voxelTriangles;

const uvec2 NO_TRIANGLE = uvec2(0xffffffffu); // the fragment covers the whole cell

uint packColor(vec3 c) {
    uvec3 v = uvec3(clamp(c, 0.0, 1.0) * vec3(2047.0, 2047.0, 1023.0) + 0.5);
    return v.r | v.g << 11 | v.b << 22;
}

vec3 unpackColor(uint w) {
    return vec3(w & 2047u, w >> 11 & 2047u, w >> 22) / vec3(2047.0, 2047.0, 1023.0);
}

// Octahedral, 12 bits per coordinate. 0 is no normal.
uint packDirection(vec3 n) {
    if (n == vec3(0.0)) return 0;
    uvec2 v = uvec2(octahedral(n) * 2047.0 + 2048.5);
    return v.x | v.y << 12;
}

vec3 unpackDirection(uint w) {
    w &= 0xffffffu;
    if (w == 0) return vec3(0.0);
    return fromOctahedral((vec2(w & 0xfffu, w >> 12) - 2048.0) / 2047.0);
}

// Offset of a surface from the cell centre along the axis that it faces [cells]. Eight bits above the normal.
uint packOffset(float offset) {
    return uint(clamp(offset, -0.5, 0.5) * 254.0 + 128.5) << 24;
}

float unpackOffset(uint w) {
    return (float(w >> 24) - 128.0) / 254.0;
}

// Largest offset of a plane that touches a cell only at a corner [cells].
const float OFFSET_REACH = 1.5;

// Offset as a ten-bit integer, for sums.
uint storedOffset(float offset) {
    return uint(clamp(offset / OFFSET_REACH, -1.0, 1.0) * 511.0 + 512.5);
}

// Front layer of a side: the outermost surface in each quarter of the cell. Five bits of offset, increasing
// outwards, 0 for none; three bits of coverage, in sevenths of the quarter.
struct FrontLayer {
    float offset; // along the axis from the cell centre [cells]
    float covers; // 0 to 1
};

// `covered`: covered mask texels of the quarter, 1 to 16.
uint packFrontLayer(float offset, uint side, int covered) {
    uint level = uint(clamp(side == 0 ? offset : -offset, -0.5, 0.5) * 30.0 + 16.5);
    return level << 3 | uint(min((covered + 1) / 2, 7));
}

FrontLayer frontLayerOf(uint word, uint side, uint quarter) {
    uint w = word >> 8 * quarter & 255u;
    float offset = (float(w >> 3) - 16.0) / 30.0;
    return FrontLayer(side == 0 ? offset : -offset, float(w & 7u) / 7.0);
}

// Merges all four quarters: keeps the outer surface, or adds the coverage of both at the same level. The
// order does not matter.
uint frontOf(uint a, uint b) {
    uint both = 0;
    for (uint i = 0; i < 32; i += 8) {
        uint x = a >> i & 255u, y = b >> i & 255u;
        both |= (x >> 3 == y >> 3 ? x & 248u | min((x & 7u) + (y & 7u), 7u) : max(x, y)) << i;
    }
    return both;
}

float offsetOfSum(float sum, float weight) {
    return (sum / max(weight, 1.0) - 512.0) / 511.0 * OFFSET_REACH;
}

// Nine bits per channel and a shared exponent (EXT_texture_shared_exponent), up to 65408.
uint packRadiance(vec3 c) {
    c = clamp(c, 0.0, 65408.0);
    float largest = max(c.r, max(c.g, c.b));
    if (largest < 1e-6) return 0;
    int exponent = clamp(int(floor(log2(largest))) + 16, 0, 31);
    if (largest / exp2(float(exponent - 24)) >= 511.5) exponent = min(exponent + 1, 31);
    uvec3 v = uvec3(c / exp2(float(exponent - 24)) + 0.5);
    return v.r | v.g << 9 | v.b << 18 | uint(exponent) << 27;
}

vec3 unpackRadiance(uint w) {
    return vec3(w & 511u, w >> 9 & 511u, w >> 18 & 511u) * exp2(float(w >> 27) - 24.0);
}

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
