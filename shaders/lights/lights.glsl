// Lights. The colour of a directional light is the irradiance E on a surface facing it; that of a point or
// spot light is the radiant intensity I, which gives I / d^2.
#ifndef LIGHTS_GLSL
#define LIGHTS_GLSL

const uint LIGHT_DIRECTIONAL = 0;
const uint LIGHT_POINT = 1;
const uint LIGHT_SPOT = 2;

struct Light {
    vec3 position;
    uint kind;
    vec3 direction; // direction of travel
    int shadow_view; // -1: no shadow; point lights own six: +x -x +y -y +z -z
    vec3 color;
    float range; // 0: unlimited
    float cos_inner;
    float cos_outer;
    uint of_sky; // 1: represents a part of the sky image
    float pad;
};

layout(std430) readonly buffer Lights { Light lights[]; } lights;

struct Incident {
    vec3 to_light; // unit length
    vec3 irradiance; // on a surface that faces the light
};

Incident incidentLight(Light light, vec3 p) {
    if (light.kind == LIGHT_DIRECTIONAL) return Incident(-light.direction, light.color);
    vec3 d = light.position - p;
    float d2 = max(dot(d, d), 1e-6);
    vec3 l = d * inversesqrt(d2);
    float falloff = 1.0 / d2;
    if (light.range > 0.0) { // the window of KHR_lights_punctual
        float x = d2 / (light.range * light.range);
        falloff *= clamp(1.0 - x * x, 0.0, 1.0);
    }
    if (light.kind == LIGHT_SPOT) {
        float t = clamp((dot(-l, light.direction) - light.cos_outer)
            / max(light.cos_inner - light.cos_outer, 1e-4), 0.0, 1.0);
        falloff *= t * t;
    }
    return Incident(l, light.color * falloff);
}

#endif
