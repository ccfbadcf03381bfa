// What escapes a cone sees the sky, the mean over the solid angle that the cone stands for.
#include "lights/sky.glsl"

vec3 coneRadiance(vec4 cone, vec3 d, float spread) {
    vec3 seen = cone.rgb;
    if (cone.a < 1.0) seen += (1.0 - cone.a) * skyRadiance(d, spread);
    return seen;
}
