// Layouts of the diffuse cones: one on the normal, the others on a ring. Weights sum to 1. With the thesis's
// set they are equal. A set answers a radiance field of order l with sum_c w_c P_l(cos tilt_c) K_l(half-angle)
// against the Lambert kernel's 1, 2/3, 1/4; the fitted ones are right for l = 0, 1, 2.
#ifndef CONE_SETS_GLSL
#define CONE_SETS_GLSL
#include "frame.glsl"

struct ConeSet {
    int count; // axial cone included
    float axial_weight; // the ring shares the rest
    float cos_tilt;
    float sin_tilt;
    float tan_half; // of the half-angle
};

ConeSet makeConeSet(int count, float axial_weight, float tilt, float aperture) {
    float angle = params.diffuse_aperture > 0.0 ? params.diffuse_aperture : aperture;
    return ConeSet(count, axial_weight, cos(radians(tilt)), sin(radians(tilt)), tan(radians(0.5 * angle)));
}

ConeSet diffuseCones() {
    if (CONE_SET == CONE_SET_THESIS) return makeConeSet(5, 0.2, 45.0, 45.0); // Section 4.5.2
    if (CONE_SET == CONE_SET_SIX60) return makeConeSet(6, 0.25, 60.0, 60.0); // Crassin et al. 2011
    if (CONE_SET == CONE_SET_WIDE) return makeConeSet(params.cone_count, 0.15, 45.0, 78.0);
    // Fitted for the lobe that lod_offset -2 leaves of the aperture, about 11 degrees to each side.
    return makeConeSet(params.cone_count, 0.33, 59.0, 44.0);
}

#endif
