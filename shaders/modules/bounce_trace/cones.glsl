// Surfels gather with narrow cones.
#include "modules/cone.glsl"

const bool BOUNCE_SAMPLES_EMITTERS = false;

vec4 traceBounce(ConeOrigin o, vec3 d, RayUse use) {
    return traceCone(o, d, tan(radians(0.5 * params.bounce_aperture)), params.diffuse_steps);
}
