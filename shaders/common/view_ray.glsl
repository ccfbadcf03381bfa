#ifndef VIEW_RAY_GLSL
#define VIEW_RAY_GLSL
#include "common/scene.glsl"

// Unit vector through a point of the image. Uses the view and projection separately: the inverse of their
// product loses the digits that a short shadow bias needs.
vec3 viewRay(vec2 pixel) {
    vec2 clip = pixel / vec2(camera.size) * 2.0 - 1.0;
    vec3 d = vec3(clip.x / camera.projection[0][0], clip.y / camera.projection[1][1], -1.0);
    return normalize(transpose(mat3(camera.view)) * d);
}

#endif
