// Volumes follow the camera. No cells are curved.
vec3 followedPosition() {
    return camera.position;
}

void aimCurved(inout VolumeMap map) {
}
