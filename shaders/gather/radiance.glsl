// What cones gather is told as.
#ifndef CONE_LIGHT_GLSL
#define CONE_LIGHT_GLSL

// Before each cone; number 0 is the specular one, 1 the diffuse one on the normal or the first, then the others; last
// come further ones of the lobe.
#ifndef CONE_BEGINS
#define CONE_BEGINS(number)
#endif

#include "common/scene.glsl"
#include "common/brdf.glsl"
#include "cones/origin.glsl"
#include "lights/sky.glsl"
#include "modules/escape.glsl"

// What a surface's cones gather.
struct Gathered {
    vec4 hemisphere; // rgb: mean radiance over the hemisphere, cosine-weighted; a: how open it is
    vec3 specular; // radiance towards the viewer
};

// The rays of a surface that are gathered here: every `of`-th of `rays`, from `first` on, and of those into its lobe and to emitters. What
// all threads gather is summed up.
struct RayShare {
    int rays;
    int emitters; // to places on them
    int first;
    int of;
};
RayShare gatherShare = RayShare(params.diffuse_cones, params.emitter_rays, 0, 1);

// Centre of the pixel that is shaded: defined by the shader.
vec2 pixelCentre();

#endif
