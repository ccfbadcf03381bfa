// Cones through filtered levels.
#include "modules/cone.glsl"

vec4 traceAny(ConeOrigin o, vec3 d, float tan_half, int steps, uint number) {
    return traceCone(o, d, tan_half, steps);
}

#include "gather/cones.glsl"
