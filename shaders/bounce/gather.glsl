// Gathers the light of a voxel side.
#ifndef BOUNCE_GATHER_GLSL
#define BOUNCE_GATHER_GLSL
#include "surfels/sides.glsl"
#include "common/ggx.glsl"
#include "common/pattern.glsl"
#include "common/random.glsl"
#include "gather/radiance.glsl"
#include "gather/emitters.glsl"

// Random shifts of a side's point sequences, so that no wall repeats a few directions.
struct SideShifts {
    vec2 directions;
    float candidate; // choice among emitter candidates
    vec4 emitters;
};

// The cell counts from the world's origin, so that directions stay when the volume moves in steps of cells.
// round: of new directions, see history/rounds.glsl.
SideShifts shiftsOf(VolumeMap map, ivec3 cell, uint axis, uint side, uint round) {
    uvec3 key = uvec3(cell + ivec3(floor(map.minimum / map.cell + 0.25)));
    Random random = Random(uvec4(key.xy, 2u * round, key.z * 6u + 2u * axis + side));
    vec4 first = next4(random);
    return SideShifts(first.xy, first.z, next4(random));
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

// World position of the centroid of a side's surfaces.
vec3 surfelPosition(VolumeMap map, ivec3 cell, uint base, uint side, uint axis) {
    vec3 center = volumeToWorld(map, cellCentre(cell));
    return center + cellAxes(map, center) * planeMiddle(base, side, axis);
}

#endif
