// Lights and their shadow maps. A directional light's colour is the irradiance E on a surface that faces
// it; a point or spot light's is the radiant intensity I, which gives I / d^2.
#ifndef LIGHTS_GLSL
#define LIGHTS_GLSL

const uint LIGHT_DIRECTIONAL = 0;
const uint LIGHT_POINT = 1;
const uint LIGHT_SPOT = 2;

struct Light {
    vec3 position;
    uint kind;
    vec3 direction; // the way the light travels
    int shadow_view; // -1: casts none; point lights own six, +x -x +y -y +z -z
    vec3 color;
    float range; // 0: no end
    float cos_inner;
    float cos_outer;
    float pad0;
    float pad1;
};

struct ShadowView {
    mat4 view_projection;
    mat4 inverse_view_projection;
    vec3 texel_size_and_depth; // x: world width of the map (at unit distance if perspective); z: 1 if perspective
    uint light;
};

layout(std430) readonly buffer Lights { Light lights[]; } lights;
layout(std430) readonly buffer ShadowViews { ShadowView views[]; } shadowViews;

struct Incident {
    vec3 to_light; // unit
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
        float t = clamp((dot(-l, light.direction) - light.cos_outer) / max(light.cos_inner - light.cos_outer, 1e-4), 0.0, 1.0);
        falloff *= t * t;
    }
    return Incident(l, light.color * falloff);
}

// Which of the six faces of a point light's shadow cube looks along d.
int cubeFace(vec3 d) {
    vec3 a = abs(d);
    if (a.x >= a.y && a.x >= a.z) return d.x >= 0.0 ? 0 : 1;
    if (a.y >= a.z) return d.y >= 0.0 ? 2 : 3;
    return d.z >= 0.0 ? 4 : 5;
}

int shadowViewOf(Light light, vec3 p) {
    return light.shadow_view + (light.kind == LIGHT_POINT ? cubeFace(p - light.position) : 0);
}

// World size of a shadow texel at p.
float shadowTexel(int view, Light light, vec3 p) {
    vec3 t = shadowViews.views[view].texel_size_and_depth;
    return t.x * (t.z > 0.0 ? distance(light.position, p) : 1.0) / float(params.shadow_dim);
}

// xy: shadow-map coordinates in [0,1]; z: depth.
vec3 shadowPosition(int view, vec3 p) {
    vec4 c = shadowViews.views[view].view_projection * vec4(p, 1.0);
    vec3 q = c.xyz / max(c.w, 1e-6); // a spot light's plane has w = 0; behind it no light arrives
    return vec3(q.xy * 0.5 + 0.5, clamp(q.z, 0.0, 1.0));
}

#endif
