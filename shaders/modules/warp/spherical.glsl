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

// Conservative bounds of the cells between two pairs of angles [cells]: planes through the eye, and the edges
// where they meet.
struct Wedge {
    vec3 away; // unit vector along its middle
    vec3 planes[4]; // normals, pointing inwards
    vec3 edges[4]; // scaled to reach 1 along `away`
    float round; // factor of the inner radius: spheres bend within a cell, and planes must stay outside
};

Wedge wedgeBetween(vec2 low, vec2 high) {
    Wedge wedge;
    vec2 middle = 0.5 * (low + high) / float(params.voxel_dim),
        reach = 0.5 * (high - low) / float(params.voxel_dim);
    float azimuth = TURN * (middle.x - 0.5), polar = 0.5 * TURN * middle.y;
    vec2 angle = vec2(TURN, 0.5 * TURN) * reach;
    wedge.round = cos(0.7 * length(angle));
    angle.y += 0.12 * angle.x * angle.x * abs(sin(2.0 * polar));
    vec3 out_flat = vec3(cos(azimuth), 0.0, sin(azimuth)), along = vec3(-sin(azimuth), 0.0, cos(azimuth));
    vec3 away = sin(polar) * out_flat + vec3(0.0, cos(polar), 0.0),
        down = cos(polar) * out_flat - vec3(0.0, sin(polar), 0.0);
    vec3 left = out_flat * sin(angle.x) + along * cos(angle.x),
        right = out_flat * sin(angle.x) - along * cos(angle.x);
    vec3 upper = away * sin(angle.y) + down * cos(angle.y), lower = away * sin(angle.y) - down * cos(angle.y);
    wedge.away = away;
    wedge.planes = vec3[4](left, right, upper, lower);
    // At a pole left and right meet in the axis.
    bool top = polar <= angle.y, bottom = polar >= 0.5 * TURN - angle.y;
    wedge.edges = vec3[4](
        top ? vec3(0, 1, 0) : cross(left, upper),
        top ? vec3(0, 1, 0) : cross(right, upper),
        bottom ? vec3(0, -1, 0) : cross(left, lower),
        bottom ? vec3(0, -1, 0) : cross(right, lower));
    for (int i = 0; i < 4; i++) wedge.edges[i] /= dot(away, wedge.edges[i]);
    return wedge;
}

// Whether a triangle touches the region between two corners [cells], conservatively. It does if an edge
// passes through the region, or if the triangle contains the whole cut of its plane. All values stay in
// registers; clipping a polygon by planes would need local memory.
bool curvedTouches(VolumeMap map, vec3 a, vec3 b, vec3 c, vec3 low, vec3 high) {
    Wedge wedge = wedgeBetween(low.xy, high.xy);
    float per_r = log(map.range.y / map.range.x) / float(params.voxel_dim);
    vec2 depth = map.range.x * exp(per_r * vec2(low.z, high.z)) * vec2(wedge.round, 1.0);
    vec3 planes[6] =
        vec3[6](wedge.away, -wedge.away, wedge.planes[0], wedge.planes[1], wedge.planes[2], wedge.planes[3]);
    float offsets[6] = float[6](-depth.x, depth.y, 0.0, 0.0, 0.0, 0.0);

    // Parameter range in which each edge is inside all planes tested until now.
    mat3 p = mat3(a - map.eye, b - map.eye, c - map.eye);
    vec3 from = vec3(0.0), to = vec3(1.0);
    for (int i = 0; i < 6; i++) {
        vec3 start = planes[i] * p + offsets[i], end = start.yzx, at = start / (start - end);
        bvec3 starts_out = lessThan(start, vec3(0.0)), ends_out = starts_out.yzx;
        if (all(starts_out)) return false;
        from = mix(from, mix(max(from, at), vec3(2.0), ends_out), starts_out);
        to = mix(mix(to, min(to, at), ends_out), to, starts_out);
    }
    if (any(lessThanEqual(from, to))) return true;

    // The corners farthest from the plane on either side.
    vec3 face = cross(b - a, c - a), before = vec3(0.0), behind = vec3(0.0);
    float level = dot(face, p[0]), least = 1e30, most = -1e30;
    for (int i = 0; i < 8; i++) {
        vec3 corner = wedge.edges[i / 2] * depth[i & 1];
        float over = dot(face, corner) - level;
        if (over < least) before = corner;
        if (over > most) behind = corner;
        least = min(least, over);
        most = max(most, over);
    }
    if (least > 0.0 || most < 0.0 || least == most) return false; // a degenerate triangle has only edges
    vec3 at = before + (behind - before) * (least / (least - most)) - p[0];
    return dot(face, cross(p[1] - p[0], at)) >= 0.0 && dot(face, cross(at, p[2] - p[0])) >= 0.0
        && dot(face, cross(p[2] - p[1], at + p[0] - p[1])) >= 0.0;
}

// Conservative range of distances [cells] in which a triangle's plane is between two pairs of angles. Empty
// if the second is less than the first. A point of the plane at distance D along the middle is D times a mean
// of the wedge's edges.
vec2 curvedDepths(VolumeMap map, vec3 a, vec3 b, vec3 c, vec2 low, vec2 high) {
    Wedge wedge = wedgeBetween(low, high);
    vec3 face = cross(b - a, c - a);
    float level = dot(face, a - map.eye),
        facing = level < 0.0 ? -1.0 : 1.0,
        least = 1e30, most = -1e30, reach = 1.0;
    for (int i = 0; i < 4; i++) {
        float over = facing * dot(face, wedge.edges[i]);
        least = min(least, over);
        most = max(most, over);
        reach = max(reach, length(wedge.edges[i])); // inner cells have other middles
    }
    if (dot(face, face) == 0.0) return vec2(-1e6, 1e6); // a line has no plane
    if (most <= 0.0) return vec2(0.0, -1.0);
    vec2 depth = vec2(abs(level) / most / reach, least > 0.0 ? abs(level) / least * reach * reach : 1e30);
    return log(max(depth, 1e-6) / map.range.x) / log(map.range.y / map.range.x) * float(params.voxel_dim);
}

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
