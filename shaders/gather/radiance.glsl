// Types shared by everything that gathers radiance.
#ifndef GATHER_RADIANCE_GLSL
#define GATHER_RADIANCE_GLSL

// Hook before each cone. Number 0 is the first specular cone. Diffuse cones follow (in thesis.ron the one
// along the normal, then the ring), then further specular cones and rays to emitter samples.
#ifndef CONE_BEGINS
#define CONE_BEGINS(number)
#endif

#include "common/scene.glsl"
#include "common/brdf.glsl"
#include "cones/origin.glsl"
#include "lights/sky.glsl"
#include "modules/escape.glsl"

// Light gathered by the cones of a surface.
struct Gathered {
    vec4 hemisphere; // rgb: mean radiance over the hemisphere, cosine-weighted; a: openness
    vec3 specular; // radiance towards the viewer
};

// Rays that this thread gathers: every `of`-th ray from `first` on, over the hemisphere, the lobe and the
// emitter samples. The results of all threads are added.
struct RayShare {
    int rays;
    int emitters; // rays to emitter samples
    int first;
    int of;
};
RayShare gatherShare = RayShare(params.diffuse_cones, params.emitter_rays, 0, 1);

// Centre of the shaded pixel, defined by the shader.
vec2 pixelCentre();

#endif
