// Cells on spheres around the camera: azimuth, angle from the vertical axis, logarithm of the distance, so
// cells keep their shape. The axes are the world's, so a turning camera moves nothing.
const float TURN = 6.28318530718;
const float POLE = 0.1; // sine of the angle from the axis below which cells do not become narrower

// Angle of (x, y) from the x axis. One Newton step makes it the exact inverse of the device's sine and
// cosine.
float angleOf(float x, float y) {
    float t = atan(y, x), r = length(vec2(x, y));
    return r > 0.0 ? t + (y * cos(t) - x * sin(t)) / r : 0.0;
}

vec3 curvedFromWorld(VolumeMap map, vec3 p) {
    vec3 d = p - map.eye;
    float r = max(length(d), 1e-6);
    vec2 angles = vec2(angleOf(d.x, d.z) / TURN + 0.5, angleOf(d.y, length(d.xz)) / (0.5 * TURN));
    return vec3(clamp(angles, 0.0, 1.0), log(r / map.range.x) / log(map.range.y / map.range.x));
}

vec3 curvedToWorld(VolumeMap map, vec3 u) {
    float r = map.range.x * pow(map.range.y / map.range.x, u.z),
        azimuth = TURN * (u.x - 0.5),
        polar = 0.5 * TURN * u.y;
    return map.eye + r * vec3(sin(polar) * cos(azimuth), cos(polar), sin(polar) * sin(azimuth));
}

mat3 curvedAxes(VolumeMap map, vec3 p) {
    vec3 d = p - map.eye;
    float dim = float(params.voxel_dim);
    float far = max(length(d), 1e-6), r = clamp(far, map.range.x, map.range.y);
    vec3 away = d / far;
    float s = length(away.xz);
    vec3 along = s > 0.0 ? vec3(-away.z, 0.0, away.x) / s : vec3(0, 0, 1);
    vec3 down = cross(away, along);
    return mat3(TURN * max(s, POLE) * r / dim * along, 0.5 * TURN * r / dim * down,
        log(map.range.y / map.range.x) * r / dim * away);
}

// Tests the distance alone: angles would cost four trigonometric functions per sample. The margin exceeds
// rounding, so the result agrees with the coordinates.
bool curvedHolds(VolumeMap map, vec3 p) {
    float r = distance(p, map.eye);
    return r > map.range.x * 1.00001 && r < map.range.y * 0.99999;
}

// No coordinates make both triangles and these cells flat.
const bool FLAT = false;

vec3 curvedFlat(VolumeMap map, vec3 p) {
    return p;
}

vec3 flatOfCurved(VolumeMap map, vec3 cells) {
    return cells;
}

vec3 curvedOfFlat(VolumeMap map, vec3 f) {
    return f;
}

#include "volume/sphere_bounds.glsl"

#include "volume/sphere_wedge.glsl"

// A sphere has no sides.
int curvedOutside(VolumeMap map, vec3 a, vec3 b, vec3 c) {
    return 0;
}

// Spheres do not turn, and with snapping they move in steps.
vec3 curvedEye(vec3 position, vec3 cell) {
    if (params.volume_snap == VOLUME_SNAP_OFF) return position;
    vec3 unit = min(2.0 * cell, vec3(0.5 * params.warp_near));
    return floor(position / unit + 0.5) * unit;
}

// Axes along which lookups blend into the next cascade at the border: the distance alone. At the seam the
// first cells follow the last.
const vec3 CURVED_BORDERS = vec3(0.0, 0.0, 1.0);
const bool CURVED_SEAM = true;

#include "volume/curved.glsl"
