// Conservative tests of a triangle against cells on spheres, for modules/warp/spherical.glsl.
#ifndef SPHERE_WEDGE_GLSL
#define SPHERE_WEDGE_GLSL

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

#endif
