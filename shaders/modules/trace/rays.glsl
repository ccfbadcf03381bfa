// Rays that meet voxels' surfaces, however far.
#include "modules/lookup.glsl"
#include "cones/rays.glsl"

vec4 traceAny(ConeOrigin o, vec3 d, float tan_half, int steps) {
    return traceVoxels(o, d);
}

#include "cones/interleaved.glsl"
