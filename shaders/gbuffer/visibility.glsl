// The visibility buffer (Burns and Hunt 2013): of each pixel the depth and the number of the triangle that is seen.
#ifndef VISIBILITY_GLSL
#define VISIBILITY_GLSL
#include "common/scene.glsl"

ivec2 targetSize() {
    return ivec2(camera.size);
}

vec4 targetClip(vec3 p, uint layer) {
    return camera.view_projection * vec4(p, 1.0);
}

float targetNear(uint layer) {
    return camera.near;
}

uint wordOf(ivec2 pixel) {
    return uint(pixel.y) * camera.size.x + uint(pixel.x);
}

#endif
