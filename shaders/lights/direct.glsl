// Light from the scene's lights, reflected once. The shader defines visibility, by a shadow map or by rays.
#ifndef DIRECT_GLSL
#define DIRECT_GLSL
#include "common/scene.glsl"
#include "lights/lights.glsl"
#include "common/brdf.glsl"

// Unshadowed fraction of the light at p, on a surface with this geometric normal (facing the viewer).
float lightVisibility(Light light, vec3 p, vec3 face, vec3 to_light);

vec3 directLight(Surface s, vec3 p, vec3 face, vec3 v) {
    vec3 sum = vec3(0.0);
    for (uint i = 0; i < sceneInfo.light_count; i++) {
        Light light = lights.lights[i];
        Incident incident = incidentLight(light, p);
        float cosine = dot(s.normal, incident.to_light);
        if (cosine <= 0.0 || dot(face, incident.to_light) <= 0.0 || incident.irradiance == vec3(0.0))
            continue;
        vec3 brdf = diffuseBrdf(s) + specularBrdf(s, v, incident.to_light);
        sum += brdf * incident.irradiance * cosine * lightVisibility(light, p, face, incident.to_light);
    }
    return sum;
}

#endif
