// Shared by the geometry and fragment stages of the raster voxelizer.
#ifndef VOXEL_RASTER_GLSL
#define VOXEL_RASTER_GLSL
#include "volume/volume.glsl"

// Whether cells are uniform in raster space, which precedes any warp function.
#define EVEN (!WARPED || CURVED)

const uint SLIVER = 4u; // flag next to the axis: drawn as its bounding rectangle

// The cascade that is drawn, never a curved one. A frustum would need pixels along depth as small as its
// nearest cell: about (far / near)^2 of them. On spheres triangles are not flat.
int rasterCascade() {
    return int(pass.index) + CASCADE_COUNT - params.box_cascades;
}

// Coordinates in [0,1]^3 before warping, where triangles are flat.
vec3 toRasterSpace(VolumeMap g, vec3 p) {
    return (p - g.minimum) / g.size;
}

// The two image axes and the depth axis of a projection along `axis`.
ivec3 planeAxes(uint axis) {
    return axis == 0 ? ivec3(1, 2, 0) :
        axis == 1 ? ivec3(0, 2, 1) :
        ivec3(0, 1, 2);
}

// Clip-space position for a projection along `axis`.
vec4 project(vec3 r, uint axis) {
    ivec3 axes = planeAxes(axis);
    return vec4(2.0 * vec2(r[axes.x], r[axes.y]) - 1.0, r[axes.z], 1.0);
}

#endif
