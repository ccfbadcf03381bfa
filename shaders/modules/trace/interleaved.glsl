// Narrow cones: rays that meet voxels' surfaces, and from near_cells on filtered levels, which know no emitters.
#include "modules/cone.glsl"

const bool DRAWS_EMITTERS = false;

vec4 traceAny(ConeOrigin o, vec3 d, float tan_half, int steps, RayUse use) {
    return traceCone(o, d, tan_half, steps);
}

#include "cones/interleaved.glsl"
