// A volume that follows goes where the camera goes.
vec3 followedPosition() {
    return camera.position;
}

vec3 followedDirection() {
    return camera.direction;
}
