// Traces a few narrow cones or rays per pixel, different ones for each pixel of an 8x8 block. Shading filters
// over the block, so each surface sees up to 64 times as many (Segovia et al. 2006). The including module of
// modules/trace defines vec4 traceAny(ConeOrigin o, vec3 d, float tan_half, int steps, RayUse use),
// exactRange and SAMPLES_EMITTERS.
#include "gather/radiance.glsl"
#include "gather/emitters.glsl"
#include "common/ggx.glsl"
#include "common/pattern.glsl"

// Index of a point in the pixel's pattern. Points of one pixel are far apart, and so are points of
// neighbours.
uint pointIndex(int i) {
    return uint(i) * 64u + patternIndex(uvec2(pixelCentre()));
}

vec2 pixelPoint(int i) {
    return r2(pointIndex(i));
}

// Each block uses other points, which turns the bias of few directions into noise.
uint patternBlock() {
    uvec2 block = uvec2(pixelCentre()) >> 3;
    return block.x * 37u + block.y * 101u;
}

vec2 blockPoint(int i) {
    return fract(pixelPoint(i) + r2(patternBlock()));
}

float largest(vec3 v) {
    return max(v.r, max(v.g, v.b));
}

// Number of rays into the specular lobe: lobe_share of the hemisphere's rays, scaled by the lobe's share of
// the surface's reflectance.
int specularRays(Surface s, vec3 v) {
    float mirrored = largest(fresnel(s, max(dot(s.normal, v), 0.0)));
    float share = mirrored / (mirrored + largest(s.albedo));
    return clamp(int(ceil(params.lobe_share * share * float(gatherShare.rays))), 1, max(gatherShare.rays, 1));
}

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

EmitterLight emitterSampleLight(EmitterSample place, Surface s, vec3 face, vec3 v, float rays, float lobe,
    float drawn, SharedRange range) {
    float cosine = dot(s.normal, place.direction);
    if (place.cosine == 0.0 || cosine <= 0.0 || dot(face, place.direction) <= 0.0)
        return EmitterLight(vec3(0.0), vec3(0.0));
    float found = drawn * place.by_area * place.distance * place.distance;
    vec3 light = place.radiance * place.cosine * cosine;
    float by_rays = place.distance < range.rays ? rays * cosine / PI : 0.0;
    float by_lobe = place.distance < range.lobe && lobe > 0.0
        ? lobe * specularDensity(s, v, place.direction)
        : 0.0;
    return EmitterLight(
        rays > 0.0 ? light * (rays / PI) / (found + by_rays) : vec3(0.0),
        lobe > 0.0 ? light * lobe * specularBrdf(s, v, place.direction) / (found + by_lobe) : vec3(0.0));
}

// Resampled importance sampling: picks one of CANDIDATES emitter samples by unshadowed contribution. `light`
// is the estimate for all of them.
EmitterSample resampleEmitter(ConeOrigin o, Surface s, vec3 face, vec3 v, int number, float rays, float lobe,
    float drawn, float tan_half, float tan_lobe, out EmitterLight light) {
    float sum = 0.0, own = 0.0;
    EmitterSample best;
    best.cosine = 0.0;
    light = EmitterLight(vec3(0.0), vec3(0.0));
    vec4 shift = r4(patternBlock(), vec4(0.5));
    float choice = fract(shift.x + float(pointIndex(number) & 0xffffu) * 0.6180339887);
    for (int k = 0; k < CANDIDATES; k++) {
        EmitterSample place = sampleEmitter(o.surface, r4(pointIndex(number * CANDIDATES + k), shift));
        SharedRange range =
            SharedRange(exactRange(o, place.direction, tan_half), exactRange(o, place.direction, tan_lobe));
        EmitterLight found = emitterSampleLight(place, s, face, v, rays, lobe, drawn, range);
        float weight =
            luminance(s.albedo * found.hemisphere / max(rays, 1.0) + found.specular / max(lobe, 1.0));
        if (weight <= 0.0) continue;
        sum += weight;
        float chance = weight / sum;
        if (choice < chance) {
            choice /= chance;
            best = place;
            light = found;
            own = weight;
        } else {
            choice = (choice - chance) / (1.0 - chance);
        }
    }
    float scale = own > 0.0 ? sum / own : 0.0;
    light.hemisphere *= scale;
    light.specular *= scale;
    return best;
}

// Traces cones over the hemisphere, then narrow cones in the specular lobe (each 1/64 of its solid angle),
// then rays to emitters. One loop for all: the tracing code is large and is compiled only once.
Gathered gather(ConeOrigin o, Surface s, vec3 face, vec3 v) {
    mat3 frame = frameOf(s.normal);
    float tan_half = tan(radians(0.5 * params.cone_aperture)), tan_lobe = 0.25 * ggxAlpha(s.roughness);
    int rays = gatherShare.rays, lobe = specularRays(s, v);
    int drawn = SAMPLES_EMITTERS && SCENE_EMITS && emitters.count > 0 ? gatherShare.emitters : 0;
    float candidates = float(drawn * CANDIDATES);
    // Solid angle that each ray represents [sr].
    float spread = PI / float(max(rays, 1)), lobe_spread = lobeSolidAngle(s) / float(max(lobe, 1));
    vec4 hemisphere = vec4(0.0);
    vec3 specular = vec3(0.0);
    for (int i = gatherShare.first; i < rays + lobe + drawn; i += gatherShare.of) {
        bool mirrors = i >= rays && i < rays + lobe, is_drawn = i >= rays + lobe;
        vec3 d, weight = vec3(0.0);
        RayUse use = WHOLE_RAY;
        EmitterLight light = EmitterLight(vec3(0.0), vec3(0.0));
        if (is_drawn) {
            EmitterSample place = resampleEmitter(o, s, face, v, i - rays - lobe, float(rays), float(lobe),
                candidates, tan_half, tan_lobe, light);
            if (place.cosine == 0.0) continue;
            d = place.direction;
            use = rayTo(place, o.surface);
        } else if (mirrors) {
            LobeSample l = specularSample(s, face, v, blockPoint(i - rays));
            d = l.direction;
            weight = l.weight;
            if (weight == vec3(0.0)) continue;
            if (drawn > 0) use = RayUse(1e30, float(lobe) * specularDensity(s, v, d), candidates, 1e30);
        } else {
            d = frame * cosineSample(pixelPoint(i));
            if (dot(d, face) <= 0.0) continue; // mapped normals lean
            if (drawn > 0) use = RayUse(1e30, float(rays) * diffuseDensity(s, d), candidates, 1e30);
        }
        CONE_BEGINS(is_drawn ? uint(params.diffuse_cones + i - rays)
            : !mirrors ? uint(i) + 1u
            : i == rays ? 0u
            : uint(params.diffuse_cones + i - rays));
        vec4 cone = traceAny(o, d,
            mirrors ? tan_lobe : tan_half,
            mirrors ? params.specular_steps : params.diffuse_steps, use);
        if (is_drawn) {
            hemisphere.rgb += (1.0 - cone.a) * light.hemisphere;
            specular += (1.0 - cone.a) * light.specular;
            continue;
        }
        vec3 found = coneRadiance(cone, d, mirrors ? lobe_spread : spread);
        if (mirrors) specular += weight * found;
        else hemisphere += vec4(found, 1.0 - cone.a);
    }
    return Gathered(hemisphere / float(max(rays, 1)), specular / float(max(lobe, 1)));
}
