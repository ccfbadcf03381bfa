// Reprojection of gathered light. `volume` and the bricks are last frame's; `placed` is the current volume.
#ifndef BOUNCE_REPROJECT_GLSL
#define BOUNCE_REPROJECT_GLSL
#include "common/scene.glsl"
#include "surfels/sides.glsl"
#include "surfels/surfels.glsl"
#include "voxels/bricks.glsl"

layout(std430) readonly buffer LastGathered { uvec2 list[]; } lastGathered;

// Last frame's packed light at p, for the surface along an axis and side. If there was no surface, the update
// count is 0.
uvec2 reprojected(vec3 p, int cascade, uint axis, uint side) {
    vec3 u = worldToVolume(volume.maps[cascade], p);
    if (!inVolume(u)) return uvec2(0);
    ivec3 cell = min(ivec3(u * float(params.voxel_dim)), ivec3(params.voxel_dim - 1));
    uint found = foundAt(cell, cascade);
    if ((found >> axis & 1u) == 0) return uvec2(0);
    return lastGathered.list[sideIndex(surfelOf(found, axis), side)];
}

#endif
