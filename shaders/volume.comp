#version 460
#extension GL_GOOGLE_include_directive : require
// Where the volume lies this frame (thesis, Section 4.1).
#define VOLUME_ACCESS
#include "params.glsl"
#include "scene.glsl"
#include "volume.glsl"

layout(local_size_x = 1) in;

void main() {
    float dim = float(params.voxel_dim);
    vec3 eye = camera.position + params.volume_offset;
    vec3 center = params.volume_center;
    vec3 size = params.volume_size;
    if (params.volume == VOLUME_SCENE) {
        // The smallest cube around the scene, 2.5 voxels wider on each side: the outermost faces then run
        // through the middle of cells instead of along their borders, where rounding would decide.
        vec3 extent = sceneInfo.bounds_max - sceneInfo.bounds_min;
        center = 0.5 * (sceneInfo.bounds_min + sceneInfo.bounds_max);
        size = vec3(max(max(extent.x, max(extent.y, extent.z)), 1e-3) * dim / (dim - 5.0));
    }
    vec3 cell = size / dim;
    if (params.volume == VOLUME_CAMERA) {
        center = eye;
        if (params.volume_snap) center = floor(center / cell + 0.5) * cell;
    }

    vec3 right = normalize(cross(camera.direction, camera.up));
    vec3 down = cross(camera.direction, right);
    float half_height = tan(0.5 * camera.fov_y);
    float half_width = half_height * float(camera.size.x) / float(camera.size.y);

    volume.grid.minimum = center - 0.5 * size;
    volume.grid.size = size;
    volume.grid.cell = cell;
    volume.grid.eye = eye;
    volume.grid.axis_x = right * half_width;
    volume.grid.axis_y = down * half_height;
    volume.grid.axis_z = camera.direction;
    volume.grid.range = vec2(params.warp_near, max(params.warp_far, params.warp_near + 0.1));
}
