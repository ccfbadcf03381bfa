#version 460
#extension GL_GOOGLE_include_directive : require
// Voxel view: draws a cube of 36 vertices for each listed cell of the shown level.
#include "params.glsl"
#include "common/scene.glsl"
#include "volume/volume.glsl"
#include "display/cubes.glsl"
#include "modules/cube_color.glsl"

layout(location = 0) flat out vec4 color;
layout(location = 1) out vec3 position;

void main() {
    const int corners[6] = int[6](0, 1, 2, 2, 1, 3);
    uvec3 size = uvec3(shownCells());
    uint number = voxelCubes.cells[gl_InstanceIndex];
    uvec3 cell = uvec3(number % size.x, number / size.x % size.y, number / (size.x * size.y));
    int face = gl_VertexIndex / 6, corner = corners[gl_VertexIndex % 6];
    vec3 at = vec3(float(corner & 1), float(corner >> 1), float(face & 1));
    at = face < 2 ? at.zxy :
        face < 4 ? at.yzx :
        at.xyz;
    VolumeMap map = volume.maps[shownCascade()];
    position = volumeToWorld(map, (vec3(cell) + at) / vec3(size));
    color = vec4(cellColor(ivec3(cell), (vec3(cell) + 0.5) / vec3(size), face), 1.0);
    // Hides the cube around the camera, which would cover the view.
    bool own = ivec3(floor(worldToVolume(map, camera.position) * vec3(size))) == ivec3(cell);
    gl_Position = own ? vec4(0.0, 0.0, 2.0, 1.0) : camera.view_projection * vec4(position, 1.0);
}
