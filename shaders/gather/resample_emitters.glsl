// Resampling of emitter samples by unshadowed contribution. gather/interleaved.glsl includes this after
// pointIndex and patternBlock.
#ifndef RESAMPLE_EMITTERS_GLSL
#define RESAMPLE_EMITTERS_GLSL

// Unshadowed contribution of an emitter sample.
struct EmitterLight {
    vec3 hemisphere; // in units of a sum over `rays` rays
    vec3 specular; // in units of a sum over `lobe` rays
};

// Length of the exact part of cones [m]. There they hit emitters and share their light with emitter samples
// (multiple importance sampling); filtered levels hold no emission.
struct SharedRange {
    float rays;
    float lobe;
};

EmitterLight emitterSampleLight(EmitterSample emitter, Surface s, vec3 face, vec3 v, float rays, float lobe,
    float drawn, SharedRange range) {
    float cosine = dot(s.normal, emitter.direction);
    if (emitter.cosine == 0.0 || cosine <= 0.0 || dot(face, emitter.direction) <= 0.0)
        return EmitterLight(vec3(0.0), vec3(0.0));
    float found = drawn * emitter.by_area * emitter.distance * emitter.distance;
    vec3 light = emitter.radiance * emitter.cosine * cosine;
    float by_rays = emitter.distance < range.rays ? rays * cosine / PI : 0.0;
    float by_lobe = emitter.distance < range.lobe && lobe > 0.0
        ? lobe * specularDensity(s, v, emitter.direction)
        : 0.0;
    return EmitterLight(
        rays > 0.0 ? light * (rays / PI) / (found + by_rays) : vec3(0.0),
        lobe > 0.0 ? light * lobe * specularBrdf(s, v, emitter.direction) / (found + by_lobe) : vec3(0.0));
}

// Resampled importance sampling: picks one of CANDIDATES emitter samples by unshadowed contribution. `light`
// is the estimate for all of them.
EmitterSample resampleEmitter(ConeOrigin o, Surface s, vec3 face, vec3 v, int number, float rays, float lobe,
    float drawn, float tan_half, float tan_lobe, out EmitterLight light) {
    EmitterSample best;
    best.cosine = 0.0;
    light = EmitterLight(vec3(0.0), vec3(0.0));
    vec4 shift = r4(patternBlock(), fract(0.5 + roundShift(pixelRound())));
    Reservoir r = Reservoir(fract(shift.x + float(pointIndex(number) & 0xffffu) * 0.6180339887), 0.0, 0.0);
    for (int k = 0; k < CANDIDATES; k++) {
        EmitterSample emitter = sampleEmitter(o.surface, r4(pointIndex(number * CANDIDATES + k), shift));
        vec3 d = emitter.direction;
        SharedRange range = SharedRange(exactRange(o, d, tan_half), exactRange(o, d, tan_lobe));
        EmitterLight found = emitterSampleLight(emitter, s, face, v, rays, lobe, drawn, range);
        float weight =
            luminance(s.albedo * found.hemisphere / max(rays, 1.0) + found.specular / max(lobe, 1.0));
        if (!takes(r, weight)) continue;
        best = emitter;
        light = found;
    }
    light.hemisphere *= reservoirScale(r);
    light.specular *= reservoirScale(r);
    return best;
}

#endif
