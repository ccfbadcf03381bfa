// A volume that follows goes beside the camera, and curved cells look beside it: voxels move under a picture that stands
// still.
vec3 followedPosition() {
    return camera.position + params.volume_offset;
}

void aimCurved(inout VolumeMap map) {
    float turn = radians(params.volume_turn);
    vec3 ahead = camera.direction;
    ahead.xz = mat2(cos(turn), -sin(turn), sin(turn), cos(turn)) * ahead.xz;
    vec3 right = normalize(cross(ahead, camera.up));
    float half_height = tan(0.5 * camera.fov_y);
    map.axis_x = right * half_height * float(camera.size.x) / float(camera.size.y);
    map.axis_y = cross(ahead, right) * half_height;
    map.axis_z = ahead;
    map.range = vec2(params.warp_near, max(params.warp_far, params.warp_near + 0.1));
}
