// Coverage mask: the 8x8 mask texels of a cell that a surface covers, projected along its axis. One byte per
// row; the first of two words holds the lower four rows.
#ifndef COVERAGE_MASK_GLSL
#define COVERAGE_MASK_GLSL

// Lateral coordinates: the two components other than the axis, in cyclic order.
vec2 lateralOf(vec3 v, uint axis) {
    if (axis == 0) return v.yz;
    return axis == 1 ? v.zx : v.xy;
}

// Whether the mask covers a point in lateral cell coordinates [0,1].
bool isCovered(uvec2 mask, vec2 lateral) {
    ivec2 at = clamp(ivec2(lateral * 8.0), 0, 7);
    return ((at.y < 4 ? mask.x : mask.y) >> (8 * (at.y & 3) + at.x) & 1u) != 0;
}

// Number of covered mask texels.
int coveredTexels(uvec2 mask) {
    return bitCount(mask.x) + bitCount(mask.y);
}

// Mask restricted to one quarter of the cell (4x4 mask texels).
uvec2 quarterOf(uvec2 mask, uint quarter) {
    uint columns = mask[quarter / 2] & 0x0f0f0f0fu << 4 * (quarter & 1);
    return quarter < 2 ? uvec2(columns, 0u) : uvec2(0u, columns);
}

// Centroid of the covered mask texels, relative to the cell centre [cells].
vec2 middleOf(uvec2 mask) {
    vec2 sum = vec2(0.0);
    float count = 0.0;
    for (int row = 0; row < 8; row++) {
        uint bits = (row < 4 ? mask.x : mask.y) >> 8 * (row & 3) & 255u;
        float row_count = float(bitCount(bits));
        // Sum of the column indices of all set bits.
        float columns = float(bitCount(bits & 0xaau) + 2 * bitCount(bits & 0xccu)
            + 4 * bitCount(bits & 0xf0u));
        sum += vec2(columns, row_count * float(row));
        count += row_count;
    }
    return count > 0.0 ? (sum / count + 0.5) / 8.0 - 0.5 : vec2(0.0);
}

#endif
