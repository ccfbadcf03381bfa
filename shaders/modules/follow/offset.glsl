// Volumes follow a point offset from the camera, and curved cells turn away from its view: voxels move while
// the image stays still.
#include "volume/aim.glsl"

vec3 followedPosition() {
    return camera.position + params.volume_offset;
}

void aimCurved(inout VolumeMap map) {
    float angle = radians(params.volume_turn);
    vec3 ahead = camera.direction;
    ahead.xz = mat2(cos(angle), -sin(angle), sin(angle), cos(angle)) * ahead.xz;
    aimAlong(map, ahead);
}
