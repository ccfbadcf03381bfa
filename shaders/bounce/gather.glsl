// How a side of a voxel gathers light.
#ifndef BOUNCE_GATHER_GLSL
#define BOUNCE_GATHER_GLSL
#include "common/sides.glsl"
#include "common/ggx.glsl"
#include "common/pattern.glsl"
#include "cones/light.glsl"
#include "cones/emitters.glsl"

// One of 64 patterns, by the place in a block of 4x4x4 cells.
uint patternOf(uvec3 cell) {
    return ((cell.x & 3u | (cell.y & 3u) << 2 | (cell.z & 3u) << 4) * 37u) & 63u;
}

// A place of some that are drawn by what each brings, and what it brings for all of them if nothing hides it: the mean radiance over the
// hemisphere.
EmitterPlace bestPlace(vec3 p, vec3 n, uint number, vec4 shift, float drawn, out vec3 light) {
    float sum = 0.0, own = 0.0, choice = fract(shift.x + float(number & 0xffffu) * 0.6180339887);
    EmitterPlace best;
    best.cosine = 0.0;
    light = vec3(0.0);
    for (uint k = 0; k < uint(CANDIDATES); k++) {
        EmitterPlace place = drawEmitter(p, evenPoint4(number * uint(CANDIDATES) + k, shift));
        float cosine = dot(n, place.direction) / PI, found = drawn * place.by_area * place.distance * place.distance;
        if (cosine <= 0.0 || place.cosine == 0.0) continue;
        vec3 brings = place.radiance * place.cosine * cosine / (found + float(params.bounce_cones) * cosine);
        float weight = luminance(brings);
        sum += weight;
        float chance = weight / sum;
        if (choice < chance) {
            choice /= chance;
            best = place;
            light = brings;
            own = weight;
        } else {
            choice = (choice - chance) / (1.0 - chance);
        }
    }
    light *= own > 0.0 ? sum / own : 0.0;
    return best;
}

// What every `of`-th ray or cone gathers, from `first` on, of the mean of all. `lamp`: it is of one.
vec3 gatherAt(vec3 p, vec3 n, bool lamp, uint pattern, int first, int of) {
    ConeOrigin o = coneOrigin(p, n, n);
    mat3 frame = frameOf(n);
    vec3 sum = vec3(0.0);
    int rays = params.bounce_cones, drawn = BOUNCE_DRAWS_EMITTERS && SCENE_EMITS && emitters.count > 0 ? params.bounce_emitter_rays : 0;
    float candidates = float(drawn * CANDIDATES), own = lamp && drawn > 0 ? OWN_LAMP * 2.0 * o.reach : 0.0;
    for (int i = first; i < rays + drawn; i += of) {
        RayUse use = MEETS_ALL;
        vec3 d, light;
        if (i < rays) {
            d = frame * cosineSample(r2(uint(i) * 64u + pattern));
            if (drawn > 0) use = RayUse(1e30, lamp ? LEAVES_ALL : float(rays) * dot(d, n) / PI, candidates, 1e30);
        } else {
            EmitterPlace place = bestPlace(o.surface, n, uint(i - rays) * 64u + pattern, vec4(0.5), candidates, light);
            if (place.cosine == 0.0 || place.distance < own) continue;
            d = place.direction;
            use = rayTo(place, o.surface);
        }
        vec4 met = traceBounce(o, d, use);
        sum += i < rays ? coneRadiance(met, d, PI / float(rays)) / float(rays) : (1.0 - met.a) * light;
    }
    return sum;
}

// Where the surfaces of a side of a surfel are.
vec3 surfelPosition(VolumeMap map, ivec3 cell, uint base, uint side, uint axis) {
    vec3 center = volumeToWorld(map, cellCentre(cell));
    return center + cellAxes(map, center) * planeMiddle(base, side, axis);
}

#endif
