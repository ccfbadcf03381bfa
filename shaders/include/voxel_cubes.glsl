// The voxel view's list of cubes.
#ifndef VOXEL_CUBES_GLSL
#define VOXEL_CUBES_GLSL

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

#endif
