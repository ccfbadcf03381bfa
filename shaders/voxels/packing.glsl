// Packed attributes of fragments, and the front layer of a side.
#ifndef VOXEL_PACKING_GLSL
#define VOXEL_PACKING_GLSL
#include "common/math.glsl"

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

// Surfaces closer to each other count as one [cells].
const float LAYER = 0.12;

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

// Mask texels of a quarter that its front layer covers, rounded up, 0 to 16.
int texelsOfFront(FrontLayer front) {
    int sevenths = int(7.0 * front.covers + 0.5);
    return sevenths == 7 ? 16 : 2 * sevenths;
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

#endif
