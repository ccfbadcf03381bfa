#ifndef SURFEL_PLACE_GLSL
#define SURFEL_PLACE_GLSL
#include "surfels/surfels.glsl"

// World position of the centroid of a side's surfaces.
vec3 surfelPosition(VolumeMap map, ivec3 cell, uint base, uint side, uint axis) {
    vec3 center = volumeToWorld(map, cellCentre(cell));
    return center + cellAxes(map, center) * planeMiddle(base, side, axis);
}

#endif
