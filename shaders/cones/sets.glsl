// Layouts of the diffuse cones: one on the normal, the others on a ring. Weights sum to 1. With the thesis's set they are
// equal. A set answers a radiance field of order l with sum_c w_c P_l(cos tilt_c) K_l(half-angle) against the Lambert
// kernel's 1, 2/3, 1/4; the fitted ones are right for l = 0, 1, 2.
#ifndef CONE_SETS_GLSL
#define CONE_SETS_GLSL
#include "common/frame.glsl"

struct ConeSet {
    int count; // axial cone included
    float axial_weight; // the ring shares the rest
    float cos_tilt;
    float sin_tilt;
    float tan_half; // of the half-angle
};

// Angles in degrees; the graph's value cone_aperture is the full angle, of the set or as diffuse_aperture says.
ConeSet makeConeSet(int count, float axial_weight, float tilt) {
    return ConeSet(max(count, 4), axial_weight, cos(radians(tilt)), sin(radians(tilt)), tan(radians(0.5 * params.cone_aperture)));
}

#include "modules/cone_set.glsl"

#endif
