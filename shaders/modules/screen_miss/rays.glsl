// Directions that hit nothing in the picture go on as rays through the voxels' surfels. Emitters have rays of
// their own, so neither these rays nor the picture include their emission.
#include "surfels/ray_origin.glsl"
#include "surfels/trace.glsl"
#include "gather/emitters.glsl"
#include "lights/sky.glsl"

vec3 missedLight(GBufferSurface seen, vec3 d, float spread, inout float open) {
    ConeOrigin o = coneOrigin(seen.position, seen.face, seen.surface.normal);
    SurfelHit met = traceSurfels(o, d, 1e30);
    if (met.light.a == 0.0) return skyRadiance(d, spread);
    open = 0.0;
    return met.light.rgb * (emitters.count > 0 ? 1.0 - met.emitted : 1.0);
}

// One emitter sample by resampled importance sampling. number: index of the slice among those of 8x8 pixels.
vec3 emitterLight(GBufferSurface seen, uint number) {
    if (emitters.count == 0) return vec3(0.0);
    ConeOrigin o = coneOrigin(seen.position, seen.face, seen.surface.normal);
    Reservoir r = Reservoir(fract(0.5 + float(number) * 0.6180339887), 0.0, 0.0);
    EmitterSample best;
    best.cosine = 0.0;
    vec3 light = vec3(0.0);
    for (uint k = 0; k < uint(CANDIDATES); k++) {
        EmitterSample emitter = sampleEmitter(o.surface, r4(number * uint(CANDIDATES) + k, vec4(0.5)));
        float cosine = dot(seen.surface.normal, emitter.direction) / PI;
        if (cosine <= 0.0 || emitter.cosine == 0.0 || dot(seen.face, emitter.direction) <= 0.0) continue;
        float density = directionDensity(emitter.by_area, emitter.distance, emitter.cosine);
        vec3 unshadowed = emitter.radiance * cosine / (density * float(CANDIDATES));
        if (!takes(r, luminance(unshadowed))) continue;
        best = emitter;
        light = unshadowed;
    }
    if (best.cosine == 0.0) return vec3(0.0);
    RayUse use = rayTo(best, o.surface);
    SurfelHit met = traceSurfels(o, best.direction, use.range);
    bool lamp = met.emitted > 0.5 && met.distance > use.lamp;
    return met.light.a > 0.0 && !lamp ? vec3(0.0) : light * reservoirScale(r);
}
