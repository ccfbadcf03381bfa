// Light of emitters at surfaces that also trace rays: multiple importance sampling (Veach and Guibas 1995) of
// emitter samples and ray hits, weighted by their pdfs. The pdf of emitter samples uses area and distance
// only: a ray hit on a voxel does not know the emitter's cosine.
#ifndef GATHER_EMITTERS_GLSL
#define GATHER_EMITTERS_GLSL
#include "lights/emitters.glsl"
#include "volume/volume.glsl"

// Whether the scene has emitters. Shaders compiled without them need fewer registers.
#ifndef SCENE_EMITS
#define SCENE_EMITS true
#endif

// Candidates for one emitter sample, resampled by unshadowed contribution (Talbot et al. 2005).
const int CANDIDATES = 8;

// Distances from an emitter sample [voxels]. A ray ends EMITTER_MARGIN before it, the precision of planes. An
// emitter that is hit at most LAMP before it is the lamp itself, which voxels may enlarge.
const float EMITTER_MARGIN = 0.25;
const float LAMP = 0.5;
// A lamp does not light itself. The sides of a small bulb would see each other, because their planes tilt too
// much or too little. Emitters this close belong to the surfel's own lamp [voxels]; emitters farther away
// light it through emitter samples alone.
const float OWN_LAMP = 3.0;
const float LEAVES_ALL = 1e-30; // density of rays that leave all emitted light to emitter samples

// Share of a ray hit's light after multiple importance sampling. emitted: the fraction of the light that
// emitters emit.
float shareOfRay(RayUse use, vec3 light, float emitted, float distance) {
    if (use.density == 0.0 || emitted == 0.0) return 1.0;
    float drawn = use.drawn * emitted * luminance(light) / emitters.power * distance * distance;
    return 1.0 - emitted * drawn / (drawn + use.density);
}

// Point `number` of a sequence that fills the four-dimensional unit cube evenly, shifted (Roberts 2018).
vec4 r4(uint number, vec4 shift) {
    return fract(shift
        + float(number & 0xffffu) * vec4(0.8566748838, 0.7338918566, 0.6287067210, 0.5385972572));
}

// Shift of that sequence from the first round to another.
vec4 roundShift(uint round) {
    return float(round) * vec4(0.2360679775, 0.6457513111, 0.3166247904, 0.6055512755);
}

// Weighted reservoir of one emitter sample (resampled importance sampling, Talbot et al. 2005).
struct Reservoir {
    float xi; // random number, stretched again at each candidate
    float sum; // of the weights
    float picked; // weight of the sample
};

// Whether a candidate becomes the sample, with the probability of its share of the weights.
bool takes(inout Reservoir r, float weight) {
    if (weight <= 0.0) return false;
    r.sum += weight;
    float probability = weight / r.sum;
    bool taken = r.xi < probability;
    if (taken) r.picked = weight;
    r.xi = taken ? r.xi / probability : (r.xi - probability) / (1.0 - probability);
    return taken;
}

// Factor from the sample's contribution to the estimate for all candidates.
float reservoirScale(Reservoir r) {
    return r.picked > 0.0 ? r.sum / r.picked : 0.0;
}

// A ray to an emitter sample.
RayUse rayTo(EmitterSample emitter, vec3 from) {
    float voxel;
    vec3 dir, p = from + emitter.distance * emitter.direction;
    cellAlong(volume.maps[cascadeAt(p)], p, emitter.direction, voxel, dir);
    return RayUse(emitter.distance - EMITTER_MARGIN * voxel, 0.0, 0.0, emitter.distance - LAMP * voxel);
}

#endif
