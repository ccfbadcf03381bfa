#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the non-empty cells of the shown level, one cube each.
#include "params.glsl"
#include "display/cubes.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;

void main() {
    uvec3 size = uvec3(shownCells());
    uvec3 cell = gl_GlobalInvocationID;
    if (any(greaterThanEqual(cell, size)) || !holdsAnything(ivec3(cell))) return;
    uint i = atomicAdd(voxelCubes.found, 1u);
    if (i >= voxelCubes.cells.length()) return;
    voxelCubes.cells[i] = cell.x + size.x * (cell.y + size.y * cell.z);
    voxelCubes.draw.x = 36;
    atomicMax(voxelCubes.draw.y, i + 1u);
}
