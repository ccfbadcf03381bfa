// A volume that follows goes where the camera goes. No cells are curved.
vec3 followedPosition() {
    return camera.position;
}

void aimCurved(inout VolumeMap map) {
}
