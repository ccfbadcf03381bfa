// Rays through the voxels over any distance, and rays to emitter samples.
#include "surfels/ray_origin.glsl"
#include "surfels/rays.glsl"
#include "modules/triangle_rays.glsl"

#define SAMPLES_EMITTERS (!WARPED && !CURVED) // bent rays do not separate emission

float diffuseTangent() {
    return 0.0;
}

float exactRange(ConeOrigin o, vec3 d, float tan_half) {
    return 1e30;
}

vec4 traceAny(ConeOrigin o, vec3 d, float tan_half, int steps, RayUse use) {
    return traceSurfaces(o, d, tan_half, use);
}

#include "gather/interleaved.glsl"
