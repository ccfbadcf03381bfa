// Gathers the light of a voxel side.
#ifndef BOUNCE_GATHER_GLSL
#define BOUNCE_GATHER_GLSL
#include "surfels/sides.glsl"
#include "surfels/place.glsl"
#include "common/ggx.glsl"
#include "common/pattern.glsl"
#include "common/random.glsl"
#include "gather/radiance.glsl"
#include "gather/emitters.glsl"

// Shifts of a side's point sequences.
struct SideShifts {
    vec2 directions;
    float candidate; // choice among emitter candidates
    vec4 emitters;
};

// Sides of 8x8 cells that face one way share sequences that fill their domains evenly, with a random shift
// and an even sequence of shifts over the rounds (history/rounds.glsl): the errors of neighbours cancel
// where all of them are seen. With random numbers for each side and round, the light behind two bends of a
// corridor varies by 2 %, after ten rounds by 0.8 %; with these sequences by 0.5 % and 0.2 %.
// Cells count from the world's origin, so that directions stay when the volume moves in steps of cells.
SideShifts shiftsOf(VolumeMap map, ivec3 cell, uint axis, uint side, uint round) {
    uvec3 place = uvec3(cell + ivec3(floor(map.minimum / map.cell + 0.25)));
    uvec2 lateral = axis == 0 ? place.yz : axis == 1 ? place.zx : place.xy;
    Random random = Random(uvec4(lateral >> 3, 0u, place[axis] * 6u + 2u * axis + side));
    vec4 first = next4(random), second = next4(random);
    float turn = float(round);
    first.xyz += turn * vec3(0.6180339887, 0.4142135624, 0.7320508076);
    second += roundShift(round);
    uint number = patternIndex(lateral), samples = uint(params.bounce_emitter_rays);
    return SideShifts(r2(number * uint(params.bounce_directions), first.xy),
        fract(first.z + float(number * samples) * 0.6180339887),
        r4(number * samples * uint(CANDIDATES), second));
}

// Resampled importance sampling: picks one of CANDIDATES emitter samples by unshadowed
// contribution. light: contribution of all candidates to the mean radiance over the hemisphere. samples:
// total number of emitter samples of the side.
EmitterSample resampleEmitter(vec3 p, vec3 n, uint index, SideShifts shifts, float samples, out vec3 light) {
    Reservoir r = Reservoir(fract(shifts.candidate + float(index & 0xffffu) * 0.6180339887), 0.0, 0.0);
    EmitterSample best;
    best.cosine = 0.0;
    light = vec3(0.0);
    for (uint k = 0; k < uint(CANDIDATES); k++) {
        EmitterSample emitter = sampleEmitter(p, r4(index * uint(CANDIDATES) + k, shifts.emitters));
        float cosine = dot(n, emitter.direction) / PI;
        float pdf = samples * emitter.by_area * emitter.distance * emitter.distance;
        if (cosine <= 0.0 || emitter.cosine == 0.0) continue;
        float pdf_sum = pdf + float(params.bounce_directions) * cosine;
        vec3 unshadowed = emitter.radiance * emitter.cosine * cosine / pdf_sum;
        if (!takes(r, luminance(unshadowed))) continue;
        best = emitter;
        light = unshadowed;
    }
    light *= reservoirScale(r);
    return best;
}

int emitterRays() {
    bool samples_emitters = BOUNCE_SAMPLES_EMITTERS && SCENE_EMITS && emitters.count > 0;
    return samples_emitters ? params.bounce_emitter_rays : 0;
}

// This thread's share (rays first, first + of, ...) of the mean radiance over the hemisphere. lamp: whether
// the surface is an emitter.
vec3 gatherAt(vec3 p, vec3 n, bool lamp, SideShifts shifts, int first, int of) {
    ConeOrigin o = coneOrigin(p, n, n);
    mat3 frame = frameOf(n);
    vec3 sum = vec3(0.0);
    int rays = params.bounce_directions, samples = emitterRays();
    float candidates = float(samples * CANDIDATES);
    float self = lamp && samples > 0 ? OWN_LAMP * 2.0 * o.reach : 0.0;
    for (int i = first; i < rays + samples; i += of) {
        RayUse use = WHOLE_RAY;
        vec3 d, light;
        if (i < rays) {
            d = frame * cosineSample(r2(uint(i), shifts.directions));
            float density = lamp ? LEAVES_ALL : float(rays) * dot(d, n) / PI;
            if (samples > 0) use = RayUse(1e30, density, candidates, 1e30);
        } else {
            EmitterSample emitter =
                resampleEmitter(o.surface, n, uint(i - rays), shifts, candidates, light);
            if (emitter.cosine == 0.0 || emitter.distance < self) continue;
            d = emitter.direction;
            use = rayTo(emitter, o.surface);
        }
        vec4 hit = traceBounce(o, d, use);
        if (i < rays) sum += coneRadiance(hit, d, PI / float(rays)) / float(rays);
        else sum += (1.0 - hit.a) * light;
    }
    return sum;
}

#endif
