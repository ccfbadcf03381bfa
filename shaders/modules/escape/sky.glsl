// The open part of a cone sees the sky, averaged over `spread`, the solid angle that the cone represents
// [sr].
#include "lights/sky.glsl"

vec3 coneRadiance(vec4 cone, vec3 d, float spread) {
    vec3 seen = cone.rgb;
    if (cone.a < 1.0) seen += (1.0 - cone.a) * skyRadiance(d, spread);
    return seen;
}
