#include "inject/exposure.glsl"

float exposure = injectionExposure(); // once for all cones of a pixel

// Radiance times the cone's openness, which darkens a second time (thesis, Algorithm 3). The sky adds
// nothing.
vec3 coneRadiance(vec4 cone, vec3 d, float spread) {
    return exposure * cone.rgb * (1.0 - cone.a);
}
