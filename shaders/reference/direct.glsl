// Direct light at a hit: every light, rectangles and discs by multiple importance sampling of their surface
// and of the specular lobe (balance heuristic; Veach and Guibas 1995).
#ifndef REFERENCE_DIRECT_GLSL
#define REFERENCE_DIRECT_GLSL
#include "lights/direct.glsl"
#include "reference/hit.glsl"
#include "common/ggx.glsl"
#include "reference/sequence.glsl"

float lightVisibility(Light light, vec3 p, vec3 face, vec3 to_light) {
    if (light.of_sky != 0) return 0.0; // part of the sky image
    if (light.shadow_view < 0) return 1.0; // casts no shadow
    vec3 from = offsetPoint(p, face);
    float end = light.kind == LIGHT_DIRECTIONAL ? 1e30 : distance(light.position, from) * 0.9999;
    return blocked(Ray(from, to_light, end)) ? 0.0 : 1.0;
}

// Whether a point of a rectangle or disc is visible along direction d.
bool seesArea(Light light, vec3 from, vec3 d, float distance) {
    return light.shadow_view < 0 || !blocked(Ray(from, d, distance * 0.9999));
}

vec3 areaDirect(Light light, SurfaceHit h, vec4 u) {
    vec3 from = offsetPoint(h.position, h.face), sum = vec3(0.0);
    float area = areaOf(light);
    vec3 to = areaPoint(light, u.xy) - from;
    float reach = length(to);
    vec3 d = to / max(reach, 1e-20);
    float cosine = dot(h.surface.normal, d), emitted = -dot(d, light.direction);
    if (cosine > 0.0 && emitted > 0.0 && dot(h.face, d) > 0.0 && seesArea(light, from, d, reach)) {
        float density = reach * reach / (area * emitted);
        sum += light.color * cosine * (diffuseBrdf(h.surface) / density
            + specularBrdf(h.surface, h.view, d) / (density + specularDensity(h.surface, h.view, d)));
    }
    LobeSample lobe = specularSample(h.surface, h.face, h.view, u.zw);
    emitted = -dot(lobe.direction, light.direction);
    if (lobe.weight == vec3(0.0) || emitted <= 0.0) return sum;
    reach = dot(from - light.position, light.direction) / emitted;
    if (reach <= 0.0 || !isOnArea(light, from + reach * lobe.direction)
            || !seesArea(light, from, lobe.direction, reach))
        return sum;
    float density = specularDensity(h.surface, h.view, lobe.direction);
    return sum + light.color * lobe.weight * density / (density + reach * reach / (area * emitted));
}

vec3 directLight(SurfaceHit h, inout Sequence random) {
    vec3 sum = vec3(0.0);
    for (uint i = 0; i < sceneInfo.light_count; i++) {
        Light light = lights.lights[i];
        if (isArea(light)) sum += areaDirect(light, h, next4(random));
        else sum += lightOn(light, h.surface, h.position, h.face, h.view);
    }
    return sum;
}

#endif
