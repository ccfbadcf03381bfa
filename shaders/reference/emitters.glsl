// Light of emitters: multiple importance sampling of emitter samples and ray hits (balance heuristic; Veach
// and Guibas 1995).
#include "lights/emitters.glsl"
#include "reference/guide.glsl"

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
LobeLight emitterLight(SurfaceHit h, uint guide, vec2 rays, inout Sequence random) {
    Surface s = h.surface;
    LobeLight none = LobeLight(vec3(0.0), vec3(0.0));
    if (emitters.count == 0) return none;
    vec3 from = offsetPoint(h.position, h.face);
    EmitterSample emitter = sampleEmitter(from, next4(random));
    float cosine = dot(s.normal, emitter.direction);
    if (emitter.cosine == 0.0 || cosine <= 0.0 || dot(h.face, emitter.direction) <= 0.0) return none;
    Ray ray = Ray(from, emitter.direction, 1e30);
    Hit hit = traceRay(ray, NO_FOOTPRINT, false);
    if (hit.triangle == NO_HIT || abs(hit.t - emitter.distance) > 1e-3 * emitter.distance) return none;
    float density = directionDensity(emitter.by_area, emitter.distance, emitter.cosine);
    vec3 light = cosine * surfaceOf(hit, ray, NO_FOOTPRINT).emission;
    return LobeLight(
        light * diffuseBrdf(s) / (density + rays.x * diffuseDirectionDensity(guide, s, emitter.direction)),
        light * specularBrdf(s, h.view, emitter.direction)
            / (density + rays.y * specularDensity(s, h.view, emitter.direction)));
}
