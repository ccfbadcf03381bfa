// Cells on spheres around the camera: azimuth, angle from the vertical axis, logarithm of the distance: cells keep their
// shape. The axes are the world's, so that a camera that turns moves nothing.
const float TURN = 6.28318530718;
const float POLE = 0.1; // cells nearer to the axis are not taken for narrower than here (a sine)

// The angle of (x, y) from the x axis; one step of Newton's method makes it the inverse of this device's sine and cosine.
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
    float r = map.range.x * pow(map.range.y / map.range.x, u.z), azimuth = TURN * (u.x - 0.5), polar = 0.5 * TURN * u.y;
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
    return mat3(TURN * max(s, POLE) * r / dim * along, 0.5 * TURN * r / dim * down, log(map.range.y / map.range.x) * r / dim * away);
}

// What is far enough and near enough: angles would cost four trigonometric functions a sample. The margin is wider than
// rounding, so that coordinates agree.
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

float segmentDistance(vec3 a, vec3 b) {
    vec3 e = b - a;
    return length(a + e * clamp(-dot(a, e) / max(dot(e, e), 1e-30), 0.0, 1.0));
}

// Whether the origin lies in a triangle's plane's projection along n into it.
bool holdsOrigin(vec3 a, vec3 b, vec3 c, vec3 n) {
    vec3 s = vec3(dot(n, cross(a, b)), dot(n, cross(b, c)), dot(n, cross(c, a)));
    return all(greaterThanEqual(s, vec3(0.0))) || all(lessThanEqual(s, vec3(0.0)));
}

// Cells that a triangle may touch. Azimuth may lie outside [0, voxel_dim]: round the seam the first cells follow the last.
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
    float inner = around ? 0.0 : min(segmentDistance(flat_a, flat_b), min(segmentDistance(flat_b, flat_c), segmentDistance(flat_c, flat_a)));
    float outer = max(length(flat_a), max(length(flat_b), length(flat_c)));
    float lowest = min(a.y, min(b.y, c.y)), highest = max(a.y, max(b.y, c.y));
    vec2 polar = vec2(atan(highest > 0.0 ? inner : outer, highest), atan(lowest > 0.0 ? outer : inner, lowest));

    vec2 azimuth = vec2(-0.5, 0.5) * TURN;
    if (!around) {
        vec3 middle = flat_a + flat_b + flat_c;
        float from = atan(middle.z, middle.x);
        vec3 x = vec3(middle.x * flat_a.x + middle.z * flat_a.z, middle.x * flat_b.x + middle.z * flat_b.z, middle.x * flat_c.x + middle.z * flat_c.z);
        vec3 z = vec3(middle.x * flat_a.z - middle.z * flat_a.x, middle.x * flat_b.z - middle.z * flat_b.x, middle.x * flat_c.z - middle.z * flat_c.x);
        vec3 turned = atan(z, x);
        azimuth = from + vec2(min(turned.x, min(turned.y, turned.z)), max(turned.x, max(turned.y, turned.z)));
    }
    float scale = 1.0 / log(map.range.y / map.range.x);
    low = vec3(azimuth.x / TURN + 0.5, polar.x / (0.5 * TURN), log(max(nearest, 1e-6) / map.range.x) * scale) * float(params.voxel_dim) - 0.01;
    high = vec3(azimuth.y / TURN + 0.5, polar.y / (0.5 * TURN), log(max(farthest, 1e-6) / map.range.x) * scale) * float(params.voxel_dim) + 0.01;
}

// A polygon's part on the side of a plane through the origin, or so far from it.
void cutAt(inout vec3 p[9], inout int count, vec3 n, float offset) {
    vec3 kept[9];
    int many = 0;
    for (int i = 0; i < count; i++) {
        vec3 a = p[i], b = p[(i + 1) % count];
        float u = dot(n, a) + offset, v = dot(n, b) + offset;
        if (u >= 0.0) kept[many++] = a;
        if (u >= 0.0 != v >= 0.0) kept[many++] = a + (b - a) * (u / (u - v));
    }
    p = kept;
    count = many;
}

// Whether a triangle touches what lies between two corners [cells], or nearly: six planes stand for its sides.
bool curvedTouches(VolumeMap map, vec3 a, vec3 b, vec3 c, vec3 low, vec3 high) {
    float dim = float(params.voxel_dim);
    vec3 middle = 0.5 * (low + high), reach = 0.5 * (high - low);
    float azimuth = TURN * (middle.x / dim - 0.5), polar = 0.5 * TURN * middle.y / dim, per_r = log(map.range.y / map.range.x) / dim;
    vec2 angle = vec2(TURN, 0.5 * TURN) * reach.xy / dim;
    float round = cos(0.7 * length(angle)); // spheres and cones bend within the cell: by so much planes lie outside
    angle.y += 0.12 * angle.x * angle.x * abs(sin(2.0 * polar));
    vec3 out_flat = vec3(cos(azimuth), 0.0, sin(azimuth)), along = vec3(-sin(azimuth), 0.0, cos(azimuth));
    vec3 away = sin(polar) * out_flat + vec3(0.0, cos(polar), 0.0), down = cos(polar) * out_flat - vec3(0.0, sin(polar), 0.0);
    vec3 p[9];
    p[0] = a - map.eye;
    p[1] = b - map.eye;
    p[2] = c - map.eye;
    int count = 3;
    cutAt(p, count, away, -map.range.x * exp(per_r * low.z) * round);
    if (count > 0) cutAt(p, count, -away, map.range.x * exp(per_r * high.z));
    if (count > 0) cutAt(p, count, out_flat * sin(angle.x) + along * cos(angle.x), 0.0);
    if (count > 0) cutAt(p, count, out_flat * sin(angle.x) - along * cos(angle.x), 0.0);
    if (count > 0) cutAt(p, count, away * sin(angle.y) + down * cos(angle.y), 0.0);
    if (count > 0) cutAt(p, count, away * sin(angle.y) - down * cos(angle.y), 0.0);
    return count > 0;
}

// A sphere has no sides.
int curvedOutside(VolumeMap map, vec3 a, vec3 b, vec3 c) {
    return 0;
}

// A sphere turns with nothing, and need not move with every step of the camera either.
vec3 curvedEye(vec3 position, vec3 cell) {
    if (params.volume_snap == VOLUME_SNAP_OFF) return position;
    vec3 unit = min(2.0 * cell, vec3(0.5 * params.warp_near));
    return floor(position / unit + 0.5) * unit;
}

// Borders that lookups blend towards the next cascade at: along the distance alone. Round the seam the first cells follow
// the last.
const vec3 CURVED_BORDERS = vec3(0.0, 0.0, 1.0);
const bool CURVED_SEAM = true;

#include "common/curved.glsl"
