// A volume that follows goes beside the camera, and looks beside it: voxels move under a picture that stands still.
vec3 followedPosition() {
    return camera.position + params.volume_offset;
}

vec3 followedDirection() {
    float turn = radians(params.volume_turn);
    vec3 ahead = camera.direction;
    ahead.xz = mat2(cos(turn), -sin(turn), sin(turn), cos(turn)) * ahead.xz;
    return ahead;
}
