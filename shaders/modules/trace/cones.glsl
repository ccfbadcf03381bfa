// A few cones per pixel, interleaved over 8x8 pixels: exact surfels while the cone is thin, then filtered
// levels. Emitter samples replace the emission that filtered levels would hold.
#define INTERLEAVED_CONES true
#include "modules/cone.glsl"
#include "cones/aperture.glsl"

#define SAMPLES_EMITTERS (!WARPED && params.levels_emit == 0)

vec4 traceAny(ConeOrigin o, vec3 d, float tan_half, int steps, RayUse use) {
    return traceCone(o, d, tan_half, steps, use);
}

#include "gather/interleaved.glsl"
