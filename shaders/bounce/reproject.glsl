// Reprojection of gathered light. `volume` and the bricks are last frame's; `placed` is the current volume.
#ifndef BOUNCE_REPROJECT_GLSL
#define BOUNCE_REPROJECT_GLSL
#include "common/scene.glsl"
#include "surfels/sides.glsl"
#include "surfels/surfels.glsl"
#include "voxels/bricks.glsl"

layout(std430) readonly buffer LastGathered { uvec2 list[]; } lastGathered;

// Index in the last frame of the side at p, for the surface along an axis; ~0 if there was none.
uint reprojected(vec3 p, int cascade, uint axis, uint side) {
    vec3 u = worldToVolume(volume.maps[cascade], p);
    if (!inVolume(u)) return ~0u;
    ivec3 cell = min(ivec3(u * float(params.voxel_dim)), ivec3(params.voxel_dim - 1));
    uint found = foundAt(cell, cascade);
    if ((found >> axis & 1u) == 0) return ~0u;
    return sideIndex(surfelOf(found, axis), side);
}

#endif
