// Directions that meet nothing in the picture see the sky.
#include "lights/sky.glsl"

vec3 missedLight(GBufferSurface seen, vec3 d, float spread, inout float open) {
    return skyRadiance(d, spread);
}

vec3 emitterLight(GBufferSurface seen, uint number) {
    return vec3(0.0);
}
