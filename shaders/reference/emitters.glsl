// Light of emitters: multiple importance sampling of emitter samples and ray hits (balance heuristic; Veach
// and Guibas 1995).
#include "lights/emitters.glsl"

// Weight of emission at a ray hit. density: pdf of the ray's direction.
float shareOfRay(float density, SurfaceHit h, float distance) {
    if (h.drawn == 0.0) return 1.0;
    return density / (density + directionDensity(h.drawn, distance, dot(h.face, h.view)));
}

struct LobeLight {
    vec3 diffuse;
    vec3 specular;
};

// Light of one emitter sample. It counts only if the ray to it hits a surface at its distance, which then
// provides the emission. rays: expected number of rays of the diffuse and the specular lobe.
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
        light * specularBrdf(s, view, place.direction)
            / (density + rays.y * specularDensity(s, view, place.direction)));
}
