// Bounds of a triangle in cells on spheres, for modules/warp/spherical.glsl.
#ifndef SPHERE_BOUNDS_GLSL
#define SPHERE_BOUNDS_GLSL

float segmentDistance(vec3 a, vec3 b) {
    vec3 e = b - a;
    return length(a + e * clamp(-dot(a, e) / max(dot(e, e), 1e-30), 0.0, 1.0));
}

// Whether the origin, projected along n, is inside a triangle.
bool holdsOrigin(vec3 a, vec3 b, vec3 c, vec3 n) {
    vec3 s = vec3(dot(n, cross(a, b)), dot(n, cross(b, c)), dot(n, cross(c, a)));
    return all(greaterThanEqual(s, vec3(0.0))) || all(lessThanEqual(s, vec3(0.0)));
}

// Bounds of the cells that a triangle may touch. Azimuth may exceed [0, voxel_dim]: at the seam the first
// cells follow the last.
void curvedBounds(VolumeMap map, vec3 a, vec3 b, vec3 c, out vec3 low, out vec3 high) {
    a -= map.eye;
    b -= map.eye;
    c -= map.eye;
    vec3 n = cross(b - a, c - a);
    float nearest = min(segmentDistance(a, b), min(segmentDistance(b, c), segmentDistance(c, a)));
    if (dot(n, n) > 0.0 && holdsOrigin(a, b, c, n)) nearest = min(nearest, abs(dot(a, n)) / length(n));
    float farthest = max(length(a), max(length(b), length(c)));

    // Distance from the vertical axis.
    vec3 flat_a = a * vec3(1, 0, 1), flat_b = b * vec3(1, 0, 1), flat_c = c * vec3(1, 0, 1);
    bool around = holdsOrigin(flat_a, flat_b, flat_c, vec3(0, 1, 0));
    float inner = around
        ? 0.0
        : min(segmentDistance(flat_a, flat_b),
            min(segmentDistance(flat_b, flat_c), segmentDistance(flat_c, flat_a)));
    float outer = max(length(flat_a), max(length(flat_b), length(flat_c)));
    float lowest = min(a.y, min(b.y, c.y)), highest = max(a.y, max(b.y, c.y));
    vec2 polar = vec2(
        atan(highest > 0.0 ? inner : outer, highest),
        atan(lowest > 0.0 ? outer : inner, lowest));

    vec2 azimuth = vec2(-0.5, 0.5) * TURN;
    if (!around) {
        vec3 middle = flat_a + flat_b + flat_c;
        float from = atan(middle.z, middle.x);
        vec3 x = vec3(middle.x * flat_a.x + middle.z * flat_a.z, middle.x * flat_b.x + middle.z * flat_b.z,
            middle.x * flat_c.x + middle.z * flat_c.z);
        vec3 z = vec3(middle.x * flat_a.z - middle.z * flat_a.x, middle.x * flat_b.z - middle.z * flat_b.x,
            middle.x * flat_c.z - middle.z * flat_c.x);
        vec3 turned = atan(z, x);
        azimuth = from + vec2(min(turned.x, min(turned.y, turned.z)), max(turned.x, max(turned.y, turned.z)));
    }
    float scale = 1.0 / log(map.range.y / map.range.x);
    low = vec3(azimuth.x / TURN + 0.5, polar.x / (0.5 * TURN),
        log(max(nearest, 1e-6) / map.range.x) * scale) * float(params.voxel_dim) - 0.01;
    high = vec3(azimuth.y / TURN + 0.5, polar.y / (0.5 * TURN),
        log(max(farthest, 1e-6) / map.range.x) * scale) * float(params.voxel_dim) + 0.01;
}

#endif
