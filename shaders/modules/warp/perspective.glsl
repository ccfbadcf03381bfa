// Cells in the view frustum, with equal steps in depth (thesis, Section 4.6.2). Coordinates behind the camera
// are -1.
vec3 curvedFromWorld(VolumeMap map, vec3 p) {
    vec3 d = p - map.eye;
    float w = dot(d, map.axis_z);
    if (w < 0.5 * map.range.x) return vec3(-1.0);
    vec2 xy = vec2(dot(d, map.axis_x) / dot(map.axis_x, map.axis_x),
        dot(d, map.axis_y) / dot(map.axis_y, map.axis_y)) / w;
    return vec3(xy * 0.5 + 0.5, (w - map.range.x) / (map.range.y - map.range.x)); // depth linear in metres
}

vec3 curvedToWorld(VolumeMap map, vec3 u) {
    float w = mix(map.range.x, map.range.y, u.z);
    return map.eye + w * (map.axis_z + (2.0 * u.x - 1.0) * map.axis_x + (2.0 * u.y - 1.0) * map.axis_y);
}

mat3 curvedAxes(VolumeMap map, vec3 p) {
    vec3 d = p - map.eye;
    float dim = float(params.voxel_dim);
    float w = clamp(dot(d, map.axis_z), map.range.x, map.range.y);
    vec3 along = map.axis_z
        + (dot(d, map.axis_x) / dot(map.axis_x, map.axis_x) * map.axis_x
            + dot(d, map.axis_y) / dot(map.axis_y, map.axis_y) * map.axis_y) / w;
    return mat3(2.0 * w / dim * map.axis_x, 2.0 * w / dim * map.axis_y,
        (map.range.y - map.range.x) / dim * along);
}

bool curvedHolds(VolumeMap map, vec3 p) {
    return inVolume(curvedFromWorld(map, p));
}

// Perspective keeps triangles flat in the coordinates of a depth buffer, where cells are boxes too.
const bool FLAT = true;

vec3 curvedFlat(VolumeMap map, vec3 p) {
    vec3 d = p - map.eye;
    float w = max(dot(d, map.axis_z), 0.5 * map.range.x);
    vec2 xy = vec2(dot(d, map.axis_x) / dot(map.axis_x, map.axis_x),
        dot(d, map.axis_y) / dot(map.axis_y, map.axis_y)) / w;
    return vec3(xy * 0.5 + 0.5, (1.0 - map.range.x / w) / (1.0 - map.range.x / map.range.y))
        * float(params.voxel_dim);
}

vec3 flatOfCurved(VolumeMap map, vec3 cells) {
    float w = max(mix(map.range.x, map.range.y, cells.z / float(params.voxel_dim)), 0.5 * map.range.x);
    return vec3(cells.xy,
        (1.0 - map.range.x / w) / (1.0 - map.range.x / map.range.y) * float(params.voxel_dim));
}

vec3 curvedOfFlat(VolumeMap map, vec3 f) {
    float per_w = max(
        (1.0 - f.z / float(params.voxel_dim) * (1.0 - map.range.x / map.range.y)) / map.range.x,
        0.5 / map.range.y);
    return vec3(f.xy, (1.0 / per_w - map.range.x) / (map.range.y - map.range.x) * float(params.voxel_dim));
}

#include "volume/flat_only.glsl"

// 1: the triangle is entirely in front of or behind the cells; 0: it crosses their near side, in front of
// which it has no coordinates; -1: test its corners' coordinates.
int curvedOutside(VolumeMap map, vec3 a, vec3 b, vec3 c) {
    vec3 w = vec3(dot(a - map.eye, map.axis_z), dot(b - map.eye, map.axis_z), dot(c - map.eye, map.axis_z));
    if (all(lessThan(w, vec3(map.range.x))) || all(greaterThan(w, vec3(map.range.y)))) return 1;
    return any(lessThan(w, vec3(map.range.x))) ? 0 : -1;
}

// Moves with the camera.
vec3 curvedEye(vec3 position, vec3 cell) {
    return position;
}

// Axes along which lookups blend into the next cascade at the border.
const vec3 CURVED_BORDERS = vec3(1.0);
const bool CURVED_SEAM = false;

#include "volume/curved.glsl"
