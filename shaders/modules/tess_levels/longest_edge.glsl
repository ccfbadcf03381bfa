// Levels that place points at most one local cell apart. The inner level follows the longest edge.

// Cells along an edge: its length over the smallest cell on the way.
float cellsAlong(VolumeMap map, vec3 a, vec3 b) {
    float edge = distance(a, b);
    if (edge == 0.0) return 0.0;
    vec3 d = (b - a) / edge;
    float cell = cellLength(map, 0.5 * (a + b), d);
    if (WARPED) cell = min(cell, min(cellLength(map, a, d), cellLength(map, b, d)));
    return edge / cell;
}

// longest: points along the longest edge.
float innerLevel(VolumeMap map, vec3 a, vec3 b, vec3 c, float longest) {
    return longest;
}
