// Voxels gather with rays that meet others' surfaces, and with rays to places on emitters.
#include "modules/lookup.glsl"
#include "cones/rays.glsl"

const bool BOUNCE_DRAWS_EMITTERS = !CURVED;

vec4 traceBounce(ConeOrigin o, vec3 d, RayUse use) {
    return traceVoxels(o, d, use);
}
