// Overlap test of the raster voxelizer, under warps too, with the corners of voxels/fragment.glsl.
#ifndef VOXEL_TESTED_GLSL
#define VOXEL_TESTED_GLSL
#include "voxels/fragment.glsl"
#include "voxels/overlap.glsl"

// Converts cells to [0,1] before warping. Coordinates outside the volume are not warped.
vec3 unwarped(vec3 cells) {
    vec3 u = cells / float(params.voxel_dim), in_volume = clamp(u, 0.0, 1.0);
    return mix(u, unwarp(in_volume), equal(in_volume, u));
}

// Position of a cell border before warping.
float border(int i) {
    return unwarp(vec3(float(i) / float(params.voxel_dim))).x;
}

// Whether the triangle overlaps a cell. Exact if cells are boxes. Under a warp, corners and cell are
// unwarped, and the test uses the cell's own coordinates.
bool overlapsCell(ivec3 cell, vec3 c[3], vec3 low, vec3 high) {
    if (EVEN) return triangleOverlapsCell(corner[0], corner[1], corner[2], cell);
    vec3 size = high - low;
    return triangleOverlapsCell((c[0] - low) / size, (c[1] - low) / size, (c[2] - low) / size, ivec3(0));
}

// Point of the triangle's plane over the cell centre, along the axis that its surface faces.
vec3 pointNear(vec3 middle, vec3 n) {
    vec3 face = cross(corner[1] - corner[0], corner[2] - corner[0]);
    uint axis = axisOf(n);
    float away = dot(face, corner[0] - middle);
    middle[axis] += clamp(away / (abs(face[axis]) > 1e-12 ? face[axis] : 1e-12), -0.5, 0.5);
    return middle;
}

#endif
