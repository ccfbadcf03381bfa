// The voxel view's list of cubes.
#ifndef VOXEL_CUBES_GLSL
#define VOXEL_CUBES_GLSL
#include "volume.glsl"

#ifndef CUBES_ACCESS
#define CUBES_ACCESS readonly
#endif
layout(std430) CUBES_ACCESS buffer VoxelCubes {
    uint draw_vertices; // VkDrawIndirectCommand: 36, cubes, 0, 0
    uint draw_instances;
    uint draw_first_vertex;
    uint draw_first_instance;
    uint found; // cells that hold anything, listed or not
    uint cells[]; // x + size * (y + size * z)
} voxelCubes;

uniform sampler3D level; // the mip of voxelRadiance that is shown; of directional levels, the first
uniform sampler3D faces; // the mip of voxelFaces that is shown, if one is

bool showsFaces() {
    return DIRECTIONAL && min(params.voxel_view_mip, params.voxel_mips - 1) > 0;
}

// Cells along an edge of the shown level.
int shownCells() {
    return showsFaces() ? textureSize(faces, 0).y : textureSize(level, 0).y;
}

// The block that is shown: where its cells begin along z.
int shownBlock() {
    return min(params.voxel_view_block, BLOCKS - 1);
}

// What rays that meet the cube's face 0 to 5 (-x, x, -y, y, -z, z) find in the cell.
vec4 shownTexel(ivec3 cell, int face) {
    cell.z += shownBlock() * shownCells();
    return showsFaces() ? texelFetch(faces, ivec3(cell.x + face * shownCells(), cell.yz), 0) : texelFetch(level, cell, 0);
}

#endif
