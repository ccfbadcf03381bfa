// A set of cones per pixel through filtered levels (thesis, Section 4.5.2).
#include "modules/cone.glsl"

vec4 traceAny(ConeOrigin o, vec3 d, float tan_half, int steps, uint number) {
    return traceCone(o, d, tan_half, steps);
}

#include "gather/cone_set.glsl"
