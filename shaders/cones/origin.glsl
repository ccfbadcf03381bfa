// Cone origins, offset from the surface.
#ifndef CONE_ORIGIN_GLSL
#define CONE_ORIGIN_GLSL
#include "volume/volume.glsl"

uniform sampler3D voxelRadiance; // premultiplied by opacity; border clamped

struct ConeOrigin {
    vec3 position; // off the surface
    vec3 normal; // geometric; cones must stay above its plane
    float height; // of position above the surface [m]
    float reach; // half the local cell's extent along the normal [m]
    int cascade; // that contains the surface
    vec3 surface; // position with a small offset, for rays
    float weight; // of this cascade; the next one gets the rest, which hides the seam between them
};

// Purpose of a ray.
struct RayUse {
    float range; // hits beyond it are ignored [m]; only rays to emitter samples have less than 1e30
    // Number of such rays times their pdf [1/sr], for multiple importance sampling with emitter samples. 0:
    // the ray gets all of the light.
    float density;
    float drawn; // number of emitter samples
    float lamp; // emitters beyond it do not occlude [m]
};

const RayUse WHOLE_RAY = RayUse(1e30, 0.0, 0.0, 1e30);

#endif
