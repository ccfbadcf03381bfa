// Colours cubes by the density of cells if params.density selects voxels.
#include "display/density.glsl"
#define cellColor plainColor
#include "display/cube_color.glsl"
#undef cellColor

vec3 cellColor(ivec3 cell, vec3 center, int face) {
    if (params.density != DENSITY_VOXELS) return plainColor(cell, center, face);
    VolumeMap map = volume.maps[shownCascade()];
    return densityColor(map, volumeToWorld(map, center));
}
