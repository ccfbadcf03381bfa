#version 460
#extension GL_GOOGLE_include_directive : require
// Writes the world coordinates of a cascade's cell borders (voxel_view_cascade), for readers outside the
// shaders, so that the warp is defined only once.
#include "params.glsl"
#include "volume/volume.glsl"

layout(local_size_x = 64) in;

layout(std430) buffer VoxelBorders {
    uint boxes; // 1: cells are boxes between the borders; 0: curved cells without borders
    uint first; // z of the cascade's first cell in the textures
    uint cells_x, cells_y, cells_z;
    float at[]; // x, y, z: voxel_dim + 1 values each [m]
} voxelBorders;

void main() {
    uint i = gl_GlobalInvocationID.x, count = uint(params.voxel_dim) + 1;
    if (i >= count) return;
    int cascade = min(params.voxel_view_cascade, CASCADE_COUNT - 1);
    VolumeMap g = volume.maps[cascade];
    voxelBorders.boxes = CURVED && g.curved != 0 ? 0 : 1;
    voxelBorders.first = uint(cascade * params.voxel_dim);
    voxelBorders.cells_x = voxelBorders.cells_y = voxelBorders.cells_z = uint(params.voxel_dim);
    vec3 p = voxelBorders.boxes != 0 ? volumeToWorld(g, vec3(float(i) / float(count - 1))) : vec3(0.0);
    for (uint axis = 0; axis < 3; axis++) voxelBorders.at[axis * count + i] = p[axis];
}
