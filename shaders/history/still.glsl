#ifndef HISTORY_STILL_GLSL
#define HISTORY_STILL_GLSL
#include "common/scene.glsl"

// Whether the view is that of the last frame.
bool cameraIsStill() {
    return camera.view_projection == camera.previous_view_projection;
}

#endif
