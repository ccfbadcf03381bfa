// Levels of the thesis (Section 4.1.2). The inner one follows the largest altitude, which leaves holes in
// obtuse triangles.

// Cells along an edge, measured at its midpoint.
float cellsAlong(VolumeMap map, vec3 a, vec3 b) {
    float edge = distance(a, b);
    if (edge == 0.0) return 0.0;
    vec3 d = (b - a) / edge;
    return edge / dot(abs(d), cellSize(map, 0.5 * (a + b)));
}

float innerLevel(VolumeMap map, vec3 a, vec3 b, vec3 c, float longest) {
    float shortest = min(distance(a, b), min(distance(b, c), distance(c, a)));
    vec3 cell = cellSize(map, (a + b + c) / 3.0);
    return params.tess_rate * length(cross(b - a, c - a)) / max(shortest, 1e-12)
        / ((cell.x + cell.y + cell.z) / 3.0);
}
