// Radiance at the end of a path, from its first ray on.
#ifndef REFERENCE_INCOMING_GLSL
#define REFERENCE_INCOMING_GLSL
#include "reference/direct.glsl"
#include "reference/sky.glsl"
#include "reference/emitters.glsl"

// Radiance that arrives at p along -d over at most params.bounces path segments, including this ray. density:
// pdf of d. sun: the sun of a sky image, returned separately if the first ray escapes.
vec3 incoming(vec3 p, vec3 d, float density, inout Random random, out bool escaped, out vec3 sun) {
    vec3 sum = vec3(0.0), weight = vec3(1.0);
    escaped = false;
    sun = vec3(0.0);
    for (int bounce = 1; bounce <= params.bounces; bounce++) {
        Ray ray = Ray(p, d, 1e30);
        Hit hit = traceRay(ray, NO_FOOTPRINT, false);
        if (hit.triangle == NO_HIT) {
            escaped = bounce == 1;
            if (!skyHasPicture()) return sum + weight * sceneInfo.sky;
            SkyShine shine = skyShine(d);
            weight *= lobeShare(shine, density);
            if (escaped) sun = weight * shine.sun;
            else sum += weight * shine.sun;
            return sum + weight * shine.sky;
        }
        SurfaceHit h = surfaceOf(hit, ray, NO_FOOTPRINT);
        vec3 emitted = h.emission * shareOfRay(density, h, hit.t);
        sum += weight * (emitted + directLight(h, random));
        float shine = luminance(fresnel(h.surface, max(dot(h.surface.normal, h.view), 0.0)));
        float probability = clamp(shine / max(shine + luminance(h.surface.albedo), 1e-6), 0.05, 0.95);
        bool last = bounce == params.bounces;
        vec2 sent = last ? vec2(0.0) : vec2(1.0 - probability, probability);
        if (skyHasPicture()) {
            SkyLight sky = skyLight(h.surface, h.position, h.face, h.view, sent, last, next4(random));
            sum += weight * (sky.diffuse + sky.specular + sky.direct);
        }
        if (last) break;
        vec4 u = next4(random);
        LobeLight from_emitters = emitterLight(h.surface, h.position, h.face, h.view, sent, random);
        sum += weight * (from_emitters.diffuse + from_emitters.specular);
        LobeSample next;
        if (u.z < probability) {
            next = specularSample(h.surface, h.face, h.view, u.xy);
            next.weight /= probability;
            density = probability * specularDensity(h.surface, h.view, next.direction);
        } else {
            next = diffuseSample(h.surface, h.face, u.xy);
            next.weight /= 1.0 - probability;
            density = (1.0 - probability) * diffuseDensity(h.surface, next.direction);
        }
        weight *= next.weight;
        if (weight == vec3(0.0)) break;
        if (bounce > 3) { // Russian roulette (Arvo and Kirk 1990)
            float survival = clamp(max(weight.r, max(weight.g, weight.b)), 0.05, 1.0);
            if (u.w >= survival) break;
            weight /= survival;
        }
        p = offsetPoint(h.position, h.face);
        d = next.direction;
    }
    return sum;
}

#endif
