// Traces a few narrow cones or rays per pixel, different ones for each pixel of an 8x8 block. Shading filters
// over the block, so each surface sees up to 64 times as many (Segovia et al. 2006). The including module of
// modules/trace defines vec4 traceAny(ConeOrigin o, vec3 d, float tan_half, int steps, RayUse use),
// exactRange, diffuseTangent (tangent of half the aperture) and SAMPLES_EMITTERS.
#include "gather/radiance.glsl"
#include "gather/emitters.glsl"
#include "common/ggx.glsl"
#include "common/pattern.glsl"
#include "history/rounds.glsl"
#include "shade/lobe_filter.glsl"

// Index of a point in the pixel's pattern. Points of one pixel are far apart, and so are points of
// neighbours.
uint pointIndex(int i) {
    return uint(i) * 64u + patternIndex(uvec2(pixelCentre()));
}

// Each round shifts all points.
vec2 pixelPoint(int i) {
    return r2(pointIndex(i), fract(0.5 + float(pixelRound()) * vec2(0.6180339887, 0.4142135624)));
}

// Shift of the points in the lobe and on emitters per block, which turns their bias into noise. Diffuse
// points repeat in every block, so that any 8x8 pixels that shading filters hold the whole pattern.
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

// Samples of a reflection, over all pixels that the filter averages, and the most rays of a pixel to get them.
const float REFLECTION_SAMPLES = 16.0;
const int SHARP_RAYS = 4;

// Least number of rays into the specular lobe. Only sharp reflections take more than one, because the filter
// averages them over few pixels.
int leastSpecularRays(Surface s) {
    float pixels = max(reflectionPixels(s), 1.0);
    return clamp(int(ceil(REFLECTION_SAMPLES / pixels)), 1, SHARP_RAYS);
}

// Number of rays into the specular lobe: lobe_share of the hemisphere's rays, scaled by the lobe's share of
// the surface's reflectance.
int specularRays(Surface s, vec3 v) {
    float mirrored = largest(fresnel(s, max(dot(s.normal, v), 0.0)));
    float share = mirrored / (mirrored + largest(s.albedo));
    int rays = min(int(ceil(params.lobe_share * share * float(gatherShare.rays))), gatherShare.rays);
    return max(rays, leastSpecularRays(s));
}

#include "gather/resample_emitters.glsl"

// Traces cones over the hemisphere, then narrow cones in the specular lobe (each 1/64 of its solid angle),
// then rays to emitters. One loop for all: the tracing code is large and is compiled only once.
Gathered gather(ConeOrigin o, Surface s, vec3 face, vec3 v) {
    mat3 frame = frameOf(s.normal);
    float tan_half = diffuseTangent(), tan_lobe = 0.25 * ggxAlpha(s.roughness);
    int rays = gatherShare.rays, lobe = specularRays(s, v);
    int drawn = SAMPLES_EMITTERS && SCENE_EMITS && emitters.count > 0 ? gatherShare.emitters : 0;
    float candidates = float(drawn * CANDIDATES);
    // Solid angle that each ray represents [sr].
    float spread = PI / float(max(rays, 1)), lobe_spread = lobeSolidAngle(s) / float(max(lobe, 1));
    vec4 hemisphere = vec4(0.0);
    vec3 specular = vec3(0.0);
    for (int i = gatherShare.first; i < rays + lobe + drawn; i += gatherShare.of) {
        bool mirrors = i >= rays && i < rays + lobe, is_drawn = i >= rays + lobe;
        // Factors of the result for each output. Emitter samples share `weight`: three more registers would cost
        // a fifth of the pass on an H100.
        vec3 d, weight = vec3(0.0), share = vec3(0.0);
        RayUse use = WHOLE_RAY;
        if (is_drawn) {
            EmitterLight light;
            EmitterSample emitter = resampleEmitter(o, s, face, v, i - rays - lobe, float(rays), float(lobe),
                candidates, tan_half, tan_lobe, light);
            if (emitter.cosine == 0.0) continue;
            d = emitter.direction;
            use = rayTo(emitter, o.surface);
            share = light.hemisphere;
            weight = light.specular;
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
            hemisphere.rgb += (1.0 - cone.a) * share;
            specular += (1.0 - cone.a) * weight;
            continue;
        }
        vec3 found = coneRadiance(cone, d, mirrors ? lobe_spread : spread);
        if (mirrors) specular += weight * found;
        else hemisphere += vec4(found, 1.0 - cone.a);
    }
    return Gathered(hemisphere / float(max(rays, 1)), specular / float(max(lobe, 1)));
}
