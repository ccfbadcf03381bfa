// A cell seen along an axis, in 8x8 parts: rows of eight bits, the lower four rows in the first of two words.
#ifndef PARTS_GLSL
#define PARTS_GLSL

// The other two coordinates of a vector, in the order x, y, z from the axis on.
vec2 besideOf(vec3 v, uint axis) {
    return axis == 0 ? v.yz : axis == 1 ? v.zx : v.xy;
}

// Whether the part is covered that has a place in the cell, [0,1].
bool isCovered(uvec2 parts, vec2 place) {
    ivec2 at = clamp(ivec2(place * 8.0), 0, 7);
    return ((at.y < 4 ? parts.x : parts.y) >> (8 * (at.y & 3) + at.x) & 1u) != 0;
}

// What is covered of a quarter: two of columns in each of two of rows.
uvec2 quarterOf(uvec2 parts, uint quarter) {
    uint columns = parts[quarter / 2] & 0x0f0f0f0fu << 4 * (quarter & 1);
    return quarter < 2 ? uvec2(columns, 0u) : uvec2(0u, columns);
}

// The middle of what is covered, from that of the cell [cells].
vec2 middleOf(uvec2 parts) {
    vec2 sum = vec2(0.0);
    float count = 0.0;
    for (int row = 0; row < 8; row++) {
        uint bits = (row < 4 ? parts.x : parts.y) >> 8 * (row & 3) & 255u;
        float many = float(bitCount(bits));
        // Sum of the places of the bits that are set.
        float columns = float(bitCount(bits & 0xaau) + 2 * bitCount(bits & 0xccu) + 4 * bitCount(bits & 0xf0u));
        sum += vec2(columns, many * float(row));
        count += many;
    }
    return count > 0.0 ? (sum / count + 0.5) / 8.0 - 0.5 : vec2(0.0);
}

#endif
