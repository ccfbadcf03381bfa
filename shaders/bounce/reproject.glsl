// Reprojection of gathered light: `volume` and bricks are the last frame's, `placed` the current volume.
#ifndef BOUNCE_REPROJECT_GLSL
#define BOUNCE_REPROJECT_GLSL
#include "common/scene.glsl"
#include "surfels/sides.glsl"
#include "surfels/surfels.glsl"
#include "voxels/bricks.glsl"

layout(std430) readonly buffer LastGathered { uvec2 list[]; } lastGathered;

// The last frame's packed light at p, of the surface along an axis and side. Zero updates if no surface was
// there.
uvec2 reprojected(vec3 p, int cascade, uint axis, uint side) {
    vec3 u = worldToVolume(volume.maps[cascade], p);
    if (!inVolume(u)) return uvec2(0);
    ivec3 cell = min(ivec3(u * float(params.voxel_dim)), ivec3(params.voxel_dim - 1));
    uint found = foundAt(cell, cascade);
    if ((found >> axis & 1u) == 0) return uvec2(0);
    return lastGathered.list[sideIndex(surfelOf(found, axis), side)];
}

#endif
