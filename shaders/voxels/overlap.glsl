// Exact overlap of a triangle and a unit cell (Schwarz and Seidel 2010): tests the plane, then the edges in
// each of the three projections. Coordinates in cells.
#ifndef OVERLAP_GLSL
#define OVERLAP_GLSL

const float OVERLAP_EPSILON = 1e-5;

bool edgeOverlaps(vec2 a, vec2 b, float orientation) {
    vec2 n = vec2(a.y - b.y, b.x - a.x) * orientation;
    return dot(n, -a) + max(n.x, 0.0) + max(n.y, 0.0) >= -OVERLAP_EPSILON * (abs(n.x) + abs(n.y));
}

bool projectionOverlaps(vec2 a, vec2 b, vec2 c, float orientation) {
    return edgeOverlaps(a, b, orientation) && edgeOverlaps(b, c, orientation)
        && edgeOverlaps(c, a, orientation);
}

bool triangleOverlapsCell(vec3 a, vec3 b, vec3 c, ivec3 cell) {
    a -= vec3(cell);
    b -= vec3(cell);
    c -= vec3(cell);
    vec3 lo = min(a, min(b, c)), hi = max(a, max(b, c));
    if (any(greaterThan(lo, vec3(1.0 + OVERLAP_EPSILON))) || any(lessThan(hi, vec3(-OVERLAP_EPSILON))))
        return false;
    vec3 n = cross(b - a, c - a);
    vec3 s = vec3(n.x < 0.0 ? -1.0 : 1.0,
        n.y < 0.0 ? -1.0 : 1.0,
        n.z < 0.0 ? -1.0 : 1.0);
    float reach = 0.5 * dot(abs(n), vec3(1.0));
    if (abs(dot(n, vec3(0.5) - a)) > reach + OVERLAP_EPSILON * length(n)) return false;
    return projectionOverlaps(a.xy, b.xy, c.xy, s.z) && projectionOverlaps(a.yz, b.yz, c.yz, s.x)
        && projectionOverlaps(a.zx, b.zx, c.zx, s.y);
}

#endif
