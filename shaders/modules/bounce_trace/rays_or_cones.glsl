// Surfels gather with rays that hit other surfels, and with rays to emitter samples. Rays bend in warped or
// curved cells, where narrow cones replace them.
#include "modules/cone.glsl"
#include "surfels/rays.glsl"

#define BOUNCE_SAMPLES_EMITTERS (!WARPED && !CURVED)

vec4 traceBounce(ConeOrigin o, vec3 d, RayUse use) {
    if (!WARPED && !CURVED) return traceStraight(o, d, use);
    return traceCone(o, d, tan(radians(0.5 * params.bounce_aperture)), params.diffuse_steps);
}
