// Inputs of the raster voxelizer's fragment stage, and its texture footprint.
#ifndef VOXELIZE_FRAGMENT_GLSL
#define VOXELIZE_FRAGMENT_GLSL
#include "materials/materials.glsl"
#include "modules/reflectance.glsl"
#include "voxels/raster.glsl"
#include "voxels/store.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 uv;
layout(location = 3) flat in uint material;
layout(location = 4) flat in uint axis;
layout(location = 5) flat in uvec2 triangle;
layout(location = 6) flat in vec3 corner[3];
layout(location = 9) in vec4 color;

// Scales the texture footprint from a pixel to a cell. Under a warp function a pixel may be smaller or larger
// than a cell. `at`: the fragment in cells.
float footprintScale(vec3 at) {
    if (EVEN) return 1.0;
    vec3 across = dFdx(at), down = dFdy(at);
    ivec3 axes = planeAxes(axis & 3u);
    return 1.0 / clamp(max(across[axes.x], down[axes.y]), 1.0 / 64.0, 64.0);
}

#endif
