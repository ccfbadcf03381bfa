// Aperture of diffuse cones.
#ifndef CONE_APERTURE_GLSL
#define CONE_APERTURE_GLSL
#include "params.glsl"

// Tangent of half the aperture.
float diffuseTangent() {
    return tan(radians(0.5 * params.cone_aperture));
}

#endif
