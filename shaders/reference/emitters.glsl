// Light of emitting surfaces, found both by drawing places on them and by the rays that a surface sends out: each way of finding a place
// has the share of it that its density has of both (multiple importance sampling, balance heuristic; Veach and Guibas 1995).
#include "lights/emitters.glsl"

// Share of emission that a ray has met. density: of the ray's direction.
float shareOfRay(float density, SurfaceHit h, float distance) {
    if (h.drawn == 0.0) return 1.0;
    return density / (density + directionDensity(h.drawn, distance, dot(h.face, h.view)));
}

struct LobeLight {
    vec3 diffuse;
    vec3 specular;
};

// The light of one place, drawn; what is behind it or before it is told by the surface that a ray there meets first. rays: how often
// the diffuse and the specular lobe send out a ray.
LobeLight emitterLight(Surface s, vec3 p, vec3 face, vec3 view, vec2 rays, inout Random random) {
    LobeLight none = LobeLight(vec3(0.0), vec3(0.0));
    if (emitters.count == 0) return none;
    vec3 from = offsetPoint(p, face);
    EmitterSample place = sampleEmitter(from, next4(random));
    float cosine = dot(s.normal, place.direction);
    if (place.cosine == 0.0 || cosine <= 0.0 || dot(face, place.direction) <= 0.0) return none;
    Ray ray = Ray(from, place.direction, 1e30);
    Hit hit = traceRay(ray, NO_FOOTPRINT, false);
    if (hit.triangle == NO_HIT || abs(hit.t - place.distance) > 1e-3 * place.distance) return none;
    float density = directionDensity(place.by_area, place.distance, place.cosine);
    vec3 light = cosine * surfaceOf(hit, ray, NO_FOOTPRINT).emission;
    return LobeLight(
        light * diffuseBrdf(s) / (density + rays.x * diffuseDensity(s, place.direction)),
        light * specularBrdf(s, view, place.direction) / (density + rays.y * specularDensity(s, view, place.direction)));
}
