// Voxels gather with rays that meet others' surfaces, and with rays to places on emitters.
#include "modules/lookup.glsl"
#include "surfels/rays.glsl"

#define BOUNCE_SAMPLES_EMITTERS (!WARPED && !CURVED) // others know no emitters

vec4 traceBounce(ConeOrigin o, vec3 d, RayUse use) {
    return traceVoxels(o, d, use);
}
