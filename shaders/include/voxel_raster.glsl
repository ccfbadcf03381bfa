// What the raster voxelizer's geometry and fragment stages agree on.
#ifndef VOXEL_RASTER_GLSL
#define VOXEL_RASTER_GLSL
#include "volume.glsl"

const uint SLIVER = 4u; // flag beside the axis: drawn as its bounding rectangle

// Homogeneous coordinates in [0,w]^3 in which triangles stay flat. Under the perspective warp depth is the
// projective one here, and made linear only in the fragment.
vec4 toRasterSpace(Grid g, vec3 p) {
    if (WARP != WARP_PERSPECTIVE) return vec4((p - g.minimum) / g.size, 1.0);
    vec3 d = p - g.eye;
    float w = dot(d, g.axis_z);
    float x = dot(d, g.axis_x) / dot(g.axis_x, g.axis_x), y = dot(d, g.axis_y) / dot(g.axis_y, g.axis_y);
    return vec4(0.5 * (x + w), 0.5 * (y + w), (w - g.range.x) * g.range.y / (g.range.y - g.range.x), w);
}

// The two image axes and the depth axis of a projection along `axis`.
ivec3 planeAxes(uint axis) {
    return axis == 0 ? ivec3(1, 2, 0) : axis == 1 ? ivec3(0, 2, 1) : ivec3(0, 1, 2);
}

// Clip-space position for a projection along `axis`. Axes that need no more pixels than cells use the lower
// part of the viewport only.
vec4 project(vec4 r, uint axis) {
    ivec3 axes = planeAxes(axis);
    vec2 used = vec2(1.0);
    if (WARP == WARP_PERSPECTIVE) used = vec2(float(params.voxel_dim) / float(params.raster_size), axis == 2 ? float(params.voxel_dim) / float(params.raster_size) : 1.0);
    return vec4(2.0 * used * vec2(r[axes.x], r[axes.y]) - r.w, r[axes.z], r.w);
}

#endif
