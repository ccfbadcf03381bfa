// The list of surfels. A surfel is the surface of a cell along one axis; it has two sides (modules/sides). Fragments add to its sums,
// which are integers: their order does not matter, and runs agree to the bit. voxels/bricks.glsl finds the surfels of a cell.
#ifndef VOXELS_GLSL
#define VOXELS_GLSL

#include "common/math.glsl"
#include "modules/sides.glsl"

// Sums over what it has, by area: colour 0-2, weight 3, normal 4-6, emission 7-9, offset 10.
const uint SIDE_WORDS = 11;
const uint SIDE_OFFSET = 10;
const uint SURFEL_CELL = SIDES * SIDE_WORDS; // cell, and above it the axis + 1; 0: no surfel
const uint SURFEL_SUM_WORDS = SURFEL_CELL + 1;

// Fixed point, times weights. Colour and normal do not overflow before a cell is covered a thousand times; emission before
// 2.6e5 / radiance times.
const float COLOR_SCALE = 4095.0;
const float NORMAL_SCALE = 2047.0;
const float EMISSION_SCALE = 16.0;
const float EMISSION_MAX = 1024.0;

layout(std430) buffer SurfelSums { uint words[]; } surfelSums;
layout(std430) buffer VoxelCounter {
    uint overflow; // fragments that were lost: a list of voxels, bricks or fragments was full
    uint count; // surfels in the list
    uint fragments; // asked for
    uint bricks; // with a surface
    uint pieces; // of triangles, queued
    uint touched; // bricks that they touch, queued
    uvec3 fragment_groups; // indirect dispatch over the fragments
    uvec3 chunk_groups; // over the words of bricks, a chunk a group (voxels/chunks.glsl)
    uvec3 word_groups; // over the words of bricks, 4 a group
    uvec3 list_groups; // over the surfels
    uvec3 side_groups; // over their sides
} voxelCounter;

// What fell into cells, in no order: cell, colour, normal and offset, emission; and beside it the triangle that it is of: its
// draw, and where its three vertices begin in `indices`.
layout(std430) buffer VoxelFragments { uvec4 list[]; } voxelFragments;
layout(std430) buffer VoxelTriangles { uvec2 list[]; } voxelTriangles;

const uvec2 NO_TRIANGLE = uvec2(0xffffffffu); // the fragment stands for all of its cell

uint packColor(vec3 c) {
    uvec3 v = uvec3(clamp(c, 0.0, 1.0) * vec3(2047.0, 2047.0, 1023.0) + 0.5);
    return v.r | v.g << 11 | v.b << 22;
}

vec3 unpackColor(uint w) {
    return vec3(w & 2047u, w >> 11 & 2047u, w >> 22) / vec3(2047.0, 2047.0, 1023.0);
}

// Octahedral, twelve bits a coordinate; 0 is no normal.
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

// Where in its cell a surface is along the axis that it faces, from the middle, in cells: eight bits above the normal's.
uint packOffset(float offset) {
    return uint(clamp(offset, -0.5, 0.5) * 254.0 + 128.5) << 24;
}

float unpackOffset(uint w) {
    return (float(w >> 24) - 128.0) / 254.0;
}

// A plane that touches its cell in a corner alone passes the cell's middle by so much along its axis [cells].
const float OFFSET_REACH = 1.5;

// Offsets as integers of ten bits, for sums.
uint storedOffset(float offset) {
    return uint(clamp(offset / OFFSET_REACH, -1.0, 1.0) * 511.0 + 512.5);
}

// Front layer of a side: in each quarter of the cell the surface that lies farthest out. Five bits of offset, growing outwards, 0 for none;
// three bits of coverage, in sevenths of the quarter.
struct FrontLayer {
    float offset; // along the axis from the cell's middle [cells]
    float covers; // 0 to 1
};

// `covered`: of the quarter's 16 parts.
uint packFrontLayer(float offset, uint side, int covered) {
    uint level = uint(clamp(side == 0 ? offset : -offset, -0.5, 0.5) * 30.0 + 16.5);
    return level << 3 | uint(min((covered + 1) / 2, 7));
}

FrontLayer frontLayerOf(uint word, uint side, uint quarter) {
    uint w = word >> 8 * quarter & 255u;
    float offset = (float(w >> 3) - 16.0) / 30.0;
    return FrontLayer(side == 0 ? offset : -offset, float(w & 7u) / 7.0);
}

// Merges four quarters: the outer surface, or the summed coverage of both at the same level. The order does not matter.
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

// Nine bits a channel and a shared exponent (EXT_texture_shared_exponent); up to 65408.
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

// x, y: up to 512; z: as many for each cascade.
uint packCell(ivec3 c) {
    return uint(c.x | c.y << 9 | c.z << 18);
}

ivec3 unpackCell(uint word) {
    return ivec3(word & 511u, word >> 9 & 511u, word >> 18 & 4095u);
}

ivec3 cellOfSurfel(uint surfel) {
    return unpackCell(surfelSums.words[surfel * SURFEL_SUM_WORDS + SURFEL_CELL]);
}

// Which axis a surfel's surfaces face along; -1: the surfel is not in use, because the list was full.
int axisOfSurfel(uint surfel) {
    return int(surfelSums.words[surfel * SURFEL_SUM_WORDS + SURFEL_CELL] >> 30) - 1;
}

// Of what is found in a cell: how many surfels the cell has, the first of them, and that of an axis.
uint surfelCount(uint texel) {
    return bitCount(texel & 7u);
}

uint firstSurfel(uint texel) {
    return texel >> 3;
}

uint surfelOf(uint texel, uint axis) {
    return firstSurfel(texel) + bitCount(texel & ((1u << axis) - 1u));
}

// The first word of one side.
uint sideBase(uint surfel, uint side) {
    return surfel * SURFEL_SUM_WORDS + side * SIDE_WORDS;
}

vec3 meanEmission(uint base) {
    float weight = float(max(surfelSums.words[base + 3], 1u));
    return vec3(surfelSums.words[base + 7], surfelSums.words[base + 8], surfelSums.words[base + 9]) / (EMISSION_SCALE * weight);
}

#endif
