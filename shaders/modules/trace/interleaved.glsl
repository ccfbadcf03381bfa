// Narrow cones: rays that meet voxels' surfaces, and from near_cells on filtered levels.
#include "modules/cone.glsl"

vec4 traceAny(ConeOrigin o, vec3 d, float tan_half, int steps) {
    return traceCone(o, d, tan_half, steps);
}

#include "cones/interleaved.glsl"
