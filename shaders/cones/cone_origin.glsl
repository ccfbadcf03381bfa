// Start of cones: bias off their own surface, outside its voxels.
#ifndef CONE_START_GLSL
#define CONE_START_GLSL
#include "cones/cascade_weight.glsl"

ConeOrigin coneOrigin(vec3 p, vec3 geometric, vec3 shading) {
    return originAbove(p, geometric, params.bias, params.ray_bias);
}

#endif
