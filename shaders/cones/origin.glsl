// Where cones start, off the surface.
#ifndef CONE_ORIGIN_GLSL
#define CONE_ORIGIN_GLSL
#include "volume/volume.glsl"

uniform sampler3D voxelRadiance; // premultiplied by opacity; border clamped

struct ConeOrigin {
    vec3 position; // off the surface
    vec3 normal; // geometric: the plane that cones must stay above
    float height; // of position above the surface [m]
    float reach; // half the local cell's extent across the surface [m]
    int cascade; // that the surface lies in
    vec3 surface; // a little off it
    float weight; // of it; of the next one, the rest: so that no seam shows where a cascade ends
};

// What a ray is for.
struct RayUse {
    float range; // what lies farther is not met [m]
    float density; // of such rays [1/sr], where places on emitters are drawn too and share their light with them; 0: the ray has all of it
    float drawn; // such places
    float lamp; // emitters that lie farther hide nothing [m]
};

const RayUse WHOLE_RAY = RayUse(1e30, 0.0, 0.0, 1e30);

#endif
