// Start of rays: ray_bias off their own surface.
#ifndef RAY_ORIGIN_GLSL
#define RAY_ORIGIN_GLSL
#include "cones/cascade_weight.glsl"

ConeOrigin coneOrigin(vec3 p, vec3 geometric, vec3 shading) {
    return originAbove(p, geometric, params.ray_bias, params.ray_bias);
}

#endif
