// Light from the scene's lights, reflected once. The shader defines visibility, by a shadow map or by rays.
#ifndef DIRECT_GLSL
#define DIRECT_GLSL
#include "common/scene.glsl"
#include "lights/polygon.glsl"
#include "common/brdf.glsl"
#ifdef AREA_LIGHTS
#include "lights/lobe_shape.glsl"
#endif

// Unshadowed fraction of the light at p, on a surface with this geometric normal (facing the viewer).
float lightVisibility(Light light, vec3 p, vec3 face, vec3 to_light);

// What a light sends to the viewer by way of a surface.
struct LightSample {
    vec3 reflected; // radiance without shadow
    vec3 to_light; // unit length; where the shadow ray goes
};

// v: to the viewer.
LightSample evaluateLight(Light light, Surface s, vec3 p, vec3 face, vec3 v) {
    Incident incident = arrivingLight(light, p, s.normal);
    LightSample none = LightSample(vec3(0.0), incident.to_light);
    float cosine = dot(s.normal, incident.to_light);
    if (cosine <= 0.0 || dot(face, incident.to_light) <= 0.0 || incident.irradiance == vec3(0.0)) return none;
#ifdef AREA_LIGHTS
    if (isArea(light))
        return LightSample(diffuseBrdf(s) * incident.irradiance * cosine + lobeLight(light, s, p, v),
            incident.to_light);
#endif
    vec3 brdf = diffuseBrdf(s) + specularBrdf(s, v, incident.to_light);
    return LightSample(brdf * incident.irradiance * cosine, incident.to_light);
}

// Light of one light that a surface reflects to the viewer.
vec3 lightOn(Light light, Surface s, vec3 p, vec3 face, vec3 v) {
    LightSample from = evaluateLight(light, s, p, face, v);
    if (from.reflected == vec3(0.0)) return vec3(0.0);
    return from.reflected * lightVisibility(light, p, face, from.to_light);
}

vec3 directLight(Surface s, vec3 p, vec3 face, vec3 v) {
    vec3 sum = vec3(0.0);
    for (uint i = 0; i < sceneInfo.light_count; i++) sum += lightOn(lights.lights[i], s, p, face, v);
    return sum;
}

#endif
