// Layout of the diffuse cones of thesis.ron: one along the normal, the others on a ring. Weights sum to 1.
// cones.ron samples directions in gather/interleaved.glsl.
#ifndef CONE_SETS_GLSL
#define CONE_SETS_GLSL
#include "common/frame.glsl"
#include "cones/aperture.glsl"

struct ConeSet {
    int count; // includes the axial cone
    float axial_weight; // the ring shares the rest
    float cos_tilt;
    float sin_tilt;
    float tan_half; // of half the aperture
};

// Angles in degrees. params.cone_aperture is the full angle, from the set or from diffuse_aperture.
ConeSet makeConeSet(int count, float axial_weight, float tilt) {
    return ConeSet(max(count, 4), axial_weight, cos(radians(tilt)), sin(radians(tilt)),
        diffuseTangent());
}

#include "modules/cone_set.glsl"

#endif
