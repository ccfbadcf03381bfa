// Volumes follow the camera, and curved cells point along its view.
#include "volume/aim.glsl"

vec3 followedPosition() {
    return camera.position;
}

void aimCurved(inout VolumeMap map) {
    aimAlong(map, camera.direction);
}
