// Coverage of a cell by a triangle: coverage mask, area and offset.
#ifndef VOXELIZE_COVERAGE_MASK_GLSL
#define VOXELIZE_COVERAGE_MASK_GLSL
#include "surfels/coverage_mask.glsl"

struct Coverage {
    uvec2 mask;
    uint weight; // area projected along the axis, at least 1 [1/16 mask texel]
    float offset; // of the triangle's plane from the cell centre, along the axis [cells]
};

Coverage fullCoverage(float offset) {
    return Coverage(uvec2(0xffffffffu), 1024u, offset);
}

// Sets mask texels with their centre inside the triangle or within MASK_REACH [mask texels] of it. Corners
// in cells. Each row is the span of columns inside all three edges (Pineda 1988). Edge-on triangles cover the
// whole cell and keep the given offset. A reach of 0.1 leaves gaps where walls meet: a corridor ten voxels
// wide loses 1 % of its light at every bounce. With 0.3, rounding decides at edges with
// round coordinates, and the mask changes when the volume moves.
const float MASK_REACH = 0.28;

Coverage triangleCoverage(vec3 a, vec3 b, vec3 c, ivec3 cell, uint axis, float offset) {
    vec3 face = cross(b - a, c - a);
    if (abs(face[axis]) < 0.1 * length(face)) return fullCoverage(offset);
    offset = dot(face, a - vec3(cell) - 0.5) / face[axis];
    vec2 p[3] = vec2[3](8.0 * lateralOf(a - vec3(cell), axis), 8.0 * lateralOf(b - vec3(cell), axis),
        8.0 * lateralOf(c - vec3(cell), axis));
    vec2 e = p[1] - p[0], f = p[2] - p[0];
    float area = 0.5 * abs(e.x * f.y - e.y * f.x), facing = sign(e.x * f.y - e.y * f.x);
    vec2 low = min(p[0], min(p[1], p[2])) - MASK_REACH, high = max(p[0], max(p[1], p[2])) + MASK_REACH;
    bool whole = true;
    for (int i = 0; i < 3; i++) {
        vec2 from = p[i], along = (p[(i + 1) % 3] - from) * facing;
        // The cell corner farthest outside the edge.
        vec2 far = vec2(along.y > 0.0 ? 8.0 : 0.0,
            along.x > 0.0 ? 0.0 : 8.0);
        whole = whole && along.x * (far.y - from.y) >= along.y * (far.x - from.x);
    }
    if (whole) return fullCoverage(offset); // the common case for large triangles
    uint rows[2] = uint[2](0u, 0u);
    float within = 0.0; // area by the midpoint rule, one span per row
    for (int row = 0; row < 8; row++) {
        float y = float(row) + 0.5;
        if (y < low.y || y > high.y) continue;
        vec2 columns = vec2(max(low.x, 0.0), min(high.x, 8.0)), exact = columns;
        for (int i = 0; i < 3; i++) {
            vec2 from = p[i], along = (p[(i + 1) % 3] - from) * facing;
            // Inside: along.x * (y - from.y) - along.y * (x - from.x) >= -reach
            float level = along.x * (y - from.y) + along.y * from.x,
                reach = MASK_REACH * (abs(along.x) + abs(along.y));
            if (along.y > 0.0) {
                exact.y = min(exact.y, level / along.y);
                columns.y = min(columns.y, (level + reach) / along.y);
            } else if (along.y < 0.0) {
                exact.x = max(exact.x, level / along.y);
                columns.x = max(columns.x, (level + reach) / along.y);
            } else {
                if (level < 0.0) exact.y = -1.0;
                if (level + reach < 0.0) columns.y = -1.0;
            }
        }
        within += max(exact.y - exact.x, 0.0);
        int first = int(ceil(columns.x - 0.5)), last = min(int(floor(columns.y - 0.5)), 7);
        if (last >= first) rows[row / 4] |= ((2u << (last - first)) - 1u) << first << 8 * (row & 3);
    }
    // The area is exact if the whole triangle is inside the cell. Otherwise the row spans approximate it.
    bool inside = all(greaterThanEqual(low, vec2(-MASK_REACH)))
        && all(lessThanEqual(high, vec2(8.0 + MASK_REACH)));
    if (!inside) area = within;
    return Coverage(uvec2(rows[0], rows[1]), uint(max(16.0 * area + 0.5, 1.0)), offset);
}

#endif
