// Radiance times the cone's openness, which darkens a second time (thesis, Algorithm 3). The sky adds
// nothing.
#include "inject/exposure.glsl"

vec3 coneRadiance(vec4 cone, vec3 d, float spread) {
    return injectionExposure() * cone.rgb * (1.0 - cone.a);
}
