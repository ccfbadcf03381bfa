// Radiance at the end of a path, from its first ray on.
#ifndef REFERENCE_INCOMING_GLSL
#define REFERENCE_INCOMING_GLSL
#include "reference/direct.glsl"
#include "reference/sky.glsl"
#include "reference/emitters.glsl"
#ifdef LEARNS
#include "reference/guide_record.glsl"
#endif

// Share of the specular lobe in the reflected light.
float specularShare(SurfaceHit h) {
    float shine = luminance(fresnel(h.surface, max(dot(h.surface.normal, h.view), 0.0)));
    return shine / max(shine + luminance(h.surface.albedo), 1e-6);
}

// Radiance that arrives at p along -d over at most params.bounces path segments, including this ray. density:
// pdf of d. sun: the sun of a sky image, returned separately if the first ray escapes.
vec3 incoming(vec3 p, vec3 d, float density, inout Sequence random, out bool escaped, out vec3 sun) {
    vec3 sum = vec3(0.0), weight = vec3(1.0);
    escaped = false;
    sun = vec3(0.0);
#ifdef LEARNS
    const int LEARNED = 8;
    GuideVertex vertices[LEARNED];
    int learned = 0;
#endif
    for (int bounce = 1; bounce <= params.bounces; bounce++) {
        Ray ray = Ray(p, d, 1e30);
        Hit hit = traceRay(ray, NO_FOOTPRINT, false);
        if (hit.triangle == NO_HIT) {
            escaped = bounce == 1;
            SkyShine shine = SkyShine(sceneInfo.sky, vec3(0.0), 0.0);
            if (skyHasPicture()) {
                shine = skyShine(d);
                weight *= lobeShare(shine, density);
            }
            if (escaped) sun = weight * shine.sun;
            else sum += weight * shine.sun;
            sum += weight * shine.sky;
            break;
        }
        SurfaceHit h = surfaceOf(hit, ray, NO_FOOTPRINT);
        vec3 emitted = h.emission * shareOfRay(density, h, hit.t);
        sum += weight * (emitted + directLight(h, random));
        float probability = clamp(specularShare(h), 0.05, 0.95);
        bool last = bounce == params.bounces;
        uint guide = guideOf(h.position, h.face);
        vec2 sent = last ? vec2(0.0) : vec2(1.0 - probability, probability);
        if (skyHasPicture()) {
            SkyLight sky = skyLight(h, guide, sent, last, next4(random));
            sum += weight * (sky.diffuse + sky.specular + sky.direct);
        }
        if (last) break;
        vec4 u = next4(random);
        LobeLight from_emitters = emitterLight(h, guide, sent, random);
        sum += weight * (from_emitters.diffuse + from_emitters.specular);
        LobeSample next;
        if (u.z < probability) {
            next = specularSample(h.surface, h.face, h.view, u.xy);
            next.weight /= probability;
            density = probability * specularDensity(h.surface, h.view, next.direction);
        } else {
            next = diffuseDirection(guide, h, u.xy, density);
            next.weight /= 1.0 - probability;
            density *= 1.0 - probability;
        }
        weight *= next.weight;
        if (weight == vec3(0.0)) break;
        // Russian roulette (Arvo and Kirk 1990) goes by reflectance. Paths that head for the light weigh
        // least, and roulette by weight would end them.
        if (bounce > 3) {
            vec3 reflected = h.surface.albedo
                + fresnel(h.surface, max(dot(h.surface.normal, h.view), 0.0));
            float survival = clamp(max(reflected.r, max(reflected.g, reflected.b)), 0.05, 1.0);
            if (u.w >= survival) break;
            weight /= survival;
        }
        p = offsetPoint(h.position, h.face);
        d = next.direction;
#ifdef LEARNS
        if (u.z >= probability && learned < LEARNED)
            vertices[learned++] = guideVertex(guide, h.surface, d, density, sum, weight);
#endif
    }
#ifdef LEARNS
    for (int i = 0; i < learned; i++) guideRecord(vertices[i], sum);
#endif
    return sum;
}

#endif
