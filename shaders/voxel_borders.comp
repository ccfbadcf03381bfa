#version 460
#extension GL_GOOGLE_include_directive : require
// World coordinates of the cells' borders, for who looks at the voxels from outside: the warp is declared once.
#include "params.glsl"
#include "volume.glsl"

layout(local_size_x = 64) in;

layout(std430) writeonly buffer VoxelBorders {
    uint boxes; // 1: cells are boxes between the borders; 0: frusta, and there are no borders
    float at[]; // x, y, z: voxel_dim + 1 each [m]
} voxelBorders;

void main() {
    uint i = gl_GlobalInvocationID.x, count = uint(params.voxel_dim) + 1;
    if (i >= count) return;
    voxelBorders.boxes = WARP != WARP_PERSPECTIVE ? 1 : 0;
    vec3 p = WARP != WARP_PERSPECTIVE ? volumeToWorld(volume.grid, vec3(float(i) / float(count - 1))) : vec3(0.0);
    for (uint axis = 0; axis < 3; axis++) voxelBorders.at[axis * count + i] = p[axis];
}
