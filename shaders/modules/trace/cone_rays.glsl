// Fills the same cones evenly with rays through the voxels, which isolates the error of filtered levels and
// steps.
#include "cones/cone_origin.glsl"
#include "surfels/rays.glsl"
#include "common/frame.glsl"
#include "cones/aperture.glsl"

#define SAMPLES_EMITTERS false

float exactRange(ConeOrigin o, vec3 d, float tan_half) {
    return 1e30;
}

vec4 traceAny(ConeOrigin o, vec3 d, float tan_half, int steps, RayUse use) {
    mat3 frame = frameOf(d);
    float least = inversesqrt(1.0 + tan_half * tan_half);
    vec2 shift = rayShift(floatBitsToUint(d.x));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < params.exact_rays; i++) {
        vec2 u = rayPoint(i, shift);
        float z = mix(1.0, least, u.x), r = sqrt(max(1.0 - z * z, 0.0)), angle = 6.28318530718 * u.y;
        sum += traceVoxels(o, frame * vec3(r * cos(angle), r * sin(angle), z), WHOLE_RAY);
    }
    return sum / float(params.exact_rays);
}

#include "gather/interleaved.glsl"
