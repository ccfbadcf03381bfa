// Aligns curved cells with the frustum of a view along `ahead`.

void aimAlong(inout VolumeMap map, vec3 ahead) {
    vec3 right = normalize(cross(ahead, camera.up));
    float half_height = tan(0.5 * camera.fov_y);
    map.axis_x = right * half_height * float(camera.size.x) / float(camera.size.y);
    map.axis_y = cross(ahead, right) * half_height;
    map.axis_z = ahead;
    map.range = vec2(params.warp_near, max(params.warp_far, params.warp_near + 0.1));
}
