// Cube list of the voxel view.
#ifndef VOXEL_CUBES_GLSL
#define VOXEL_CUBES_GLSL
#include "volume/volume.glsl"

layout(std430) buffer VoxelCubes {
    uvec4 draw; // VkDrawIndirectCommand: 36, cubes, 0, 0
    uint found; // non-empty cells, including those beyond the capacity
    uint cells[]; // x + size * (y + size * z)
} voxelCubes;

uniform sampler3D level; // the shown mip of voxelRadiance

// Cells along an edge of the shown level.
int shownCells() {
    return textureSize(level, 0).y;
}

// The shown cascade.
int shownCascade() {
    return min(params.voxel_view_cascade, CASCADE_COUNT - 1);
}

// Texel of the cell for rays that hit the cube's face 0 to 5 (-x, x, -y, y, -z, z).
vec4 shownTexel(ivec3 cell, int face) {
    cell.z += shownCascade() * shownCells();
    return texelFetch(level,
        ivec3(cell.x + (params.radiance_faces > 1 ? face * shownCells() : 0), cell.yz), 0);
}

bool holdsAnything(ivec3 cell) {
    bool any_face = false;
    for (int face = 0; face < params.radiance_faces; face++)
        any_face = any_face || shownTexel(cell, face).a > 0.0;
    return any_face;
}

#endif
