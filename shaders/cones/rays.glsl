// What cones approximate: rays through the level-0 voxels, met one by one. Costs a hundred times a cone, and says what
// of an image's error is the voxels', the cones' and the filtering's.
#ifndef VOXEL_RAYS_GLSL
#define VOXEL_RAYS_GLSL
#include "cones/origin.glsl"
#include "common/random.glsl"

vec2 pixelCentre();

// A turn of the sample pattern for each pixel, so that few rays look like noise and not like bands.
vec2 rayShift(uint cone) {
    Random random = Random(uvec4(uvec2(pixelCentre()), cone, 0u));
    return next4(random).xy;
}

// Point i of an additive recurrence that fills the square evenly (Roberts 2018, R2).
vec2 rayPoint(int i, vec2 shift) {
    return fract(shift + float(i) * vec2(0.7548776662, 0.5698402910));
}

#include "modules/rays.glsl"

#endif
