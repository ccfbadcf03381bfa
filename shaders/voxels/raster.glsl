// What the raster voxelizer's geometry and fragment stages agree on.
#ifndef VOXEL_RASTER_GLSL
#define VOXEL_RASTER_GLSL
#include "volume/volume.glsl"

// Triangles are drawn before a warp function bends the cells.
#define EVEN (!WARPED || CURVED)

const uint SLIVER = 4u; // flag beside the axis: drawn as its bounding rectangle

// The cascade that is drawn. Not a curved one: in a frustum with depth in equal steps, pixels along depth must be as small
// as the nearest cell is against the farthest, (far / near)^2 of them near the camera; on spheres triangles are not flat.
int rasterCascade() {
    return int(pass.index) + CASCADE_COUNT - params.box_cascades;
}

// Coordinates in [0,1]^3, before warping: triangles are flat in them.
vec3 toRasterSpace(VolumeMap g, vec3 p) {
    return (p - g.minimum) / g.size;
}

// The two image axes and the depth axis of a projection along `axis`.
ivec3 planeAxes(uint axis) {
    return axis == 0 ? ivec3(1, 2, 0) : axis == 1 ? ivec3(0, 2, 1) : ivec3(0, 1, 2);
}

// Clip-space position for a projection along `axis`.
vec4 project(vec3 r, uint axis) {
    ivec3 axes = planeAxes(axis);
    return vec4(2.0 * vec2(r[axes.x], r[axes.y]) - 1.0, r[axes.z], 1.0);
}

#endif
