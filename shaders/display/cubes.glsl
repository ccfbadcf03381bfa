// The voxel view's list of cubes.
#ifndef VOXEL_CUBES_GLSL
#define VOXEL_CUBES_GLSL
#include "common/volume.glsl"

layout(std430) buffer VoxelCubes {
    uvec4 draw; // VkDrawIndirectCommand: 36, cubes, 0, 0
    uint found; // cells that hold anything, listed or not
    uint cells[]; // x + size * (y + size * z)
} voxelCubes;

uniform sampler3D level; // the mip of voxelRadiance that is shown; of levels by direction, the first
uniform sampler3D directions; // the mip of voxelRadianceAniso that is shown, if one is

bool showsDirections() {
    return params.view_directions != 0;
}

// Cells along an edge of the shown level.
int shownCells() {
    return showsDirections() ? textureSize(directions, 0).y : textureSize(level, 0).y;
}

// The cascade that is shown: where its cells begin along z.
int shownCascade() {
    return min(params.voxel_view_cascade, CASCADE_COUNT - 1);
}

// What rays that meet the cube's face 0 to 5 (-x, x, -y, y, -z, z) find in the cell.
vec4 shownTexel(ivec3 cell, int face) {
    cell.z += shownCascade() * shownCells();
    return showsDirections() ? texelFetch(directions, ivec3(cell.x + face * shownCells(), cell.yz), 0) : texelFetch(level, cell, 0);
}

#endif
