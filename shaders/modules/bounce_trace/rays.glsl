// Surfels gather with rays through the voxels, and with rays to emitter samples.
#include "surfels/ray_origin.glsl"
#include "surfels/rays.glsl"

#define BOUNCE_SAMPLES_EMITTERS (!WARPED && !CURVED) // bent rays do not separate emission

vec4 traceBounce(ConeOrigin o, vec3 d, RayUse use) {
    return traceVoxels(o, d, use);
}
