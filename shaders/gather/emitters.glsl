// Light of emitters at surfaces that also send out rays: places on emitters are drawn, and what rays meet of emission is shared with
// them (multiple importance sampling, Veach and Guibas 1995). Both find a place with the share that its density has of both; that of
// places drawn is told by area and distance, without the cosine on the emitter, which who meets a voxel does not know.
#ifndef CONE_EMITTERS_GLSL
#define CONE_EMITTERS_GLSL
#include "lights/emitters.glsl"
#include "volume/volume.glsl"

// Whether anything emits. Shaders that know that nothing does need fewer registers.
#ifndef SCENE_EMITS
#define SCENE_EMITS true
#endif

// Of this many places one is taken, by what it would bring if nothing hid it (Talbot et al. 2005).
const int CANDIDATES = 8;

// So far before a place a ray ends: planes are not exacter than this. And so far before it an emitter that is met is the lamp itself,
// which voxels may show larger than it is [voxels].
const float EMITTER_MARGIN = 0.25;
const float LAMP = 0.5;
// A lamp does not light itself: of a bulb of few voxels each side would see others, whose planes lean more or less than they should, and
// what it gathered would be found by rays that leave the lamp's own light to the drawn places. So near, emitters are the side's own [voxels];
// what lies farther it is lit by as places that are drawn alone.
const float OWN_LAMP = 3.0;
const float LEAVES_ALL = 1e-30; // density of rays that have no share of emitted light

// Share of the light that a ray has met. emitted: the part of it that emitters emit.
float shareOfRay(RayUse use, vec3 light, float emitted, float distance) {
    if (use.density == 0.0 || emitted == 0.0) return 1.0;
    float drawn = use.drawn * emitted * luminance(light) / emitters.power * distance * distance;
    return 1.0 - emitted * drawn / (drawn + use.density);
}

// Number `number` of points that fill the cube of four dimensions evenly, moved by a shift (Roberts 2018).
vec4 r4(uint number, vec4 shift) {
    return fract(shift + float(number & 0xffffu) * vec4(0.8566748838, 0.7338918566, 0.6287067210, 0.5385972572));
}

// A ray to a place.
RayUse rayTo(EmitterSample place, vec3 from) {
    float voxel;
    vec3 dir, p = from + place.distance * place.direction;
    cellAlong(volume.maps[cascadeAt(p)], p, place.direction, voxel, dir);
    return RayUse(place.distance - EMITTER_MARGIN * voxel, 0.0, 0.0, place.distance - LAMP * voxel);
}

#endif
