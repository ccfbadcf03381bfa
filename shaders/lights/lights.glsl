// Lights. The colour of a directional light is the irradiance E on a surface facing it; that of a point or
// spot light is the radiant intensity I, which gives I / d^2; that of a rectangle or disc is the radiance of
// its front.
#ifndef LIGHTS_GLSL
#define LIGHTS_GLSL
#include "common/math.glsl"

const uint LIGHT_DIRECTIONAL = 0;
const uint LIGHT_POINT = 1;
const uint LIGHT_SPOT = 2;
const uint LIGHT_RECTANGLE = 3;
const uint LIGHT_DISC = 4;

struct Light {
    vec3 position;
    uint kind;
    vec3 direction; // direction of travel; of a rectangle or disc: to its front
    int shadow_view; // -1: no shadow; a cube owns six: +x -x +y -y +z -z
    vec3 color;
    uint of_sky; // 1: represents a part of the sky image
    vec3 side; // half extent of a rectangle or disc
    float cos_inner;
    vec3 top; // half extent, along cross(side, direction): form factors of the other orientation are negative
    float cos_outer;
};

layout(std430) readonly buffer Lights { Light lights[]; } lights;

// Kinds with an extent follow the others.
bool isArea(Light light) {
    return light.kind >= LIGHT_RECTANGLE;
}

// Whether its shadow map is a cube.
bool castsAround(Light light) {
    return light.kind == LIGHT_POINT || isArea(light);
}

// Area of a rectangle or disc [m^2].
float areaOf(Light light) {
    return (light.kind == LIGHT_RECTANGLE ? 4.0 : PI) * length(light.side) * length(light.top);
}

// A point on a rectangle or disc, uniform by area. u: two numbers in [0, 1).
vec3 areaPoint(Light light, vec2 u) {
    vec2 at = 2.0 * u - 1.0;
    if (light.kind == LIGHT_DISC) {
        float angle = 2.0 * PI * u.y;
        at = sqrt(u.x) * vec2(cos(angle), sin(angle));
    }
    return light.position + at.x * light.side + at.y * light.top;
}

// Whether a point in the plane of a rectangle or disc is on it.
bool isOnArea(Light light, vec3 q) {
    vec3 d = q - light.position;
    vec2 at = vec2(dot(d, light.side), dot(d, light.top))
        / vec2(dot(light.side, light.side), dot(light.top, light.top));
    return light.kind == LIGHT_DISC ? dot(at, at) <= 1.0 : max(abs(at.x), abs(at.y)) <= 1.0;
}

struct Incident {
    vec3 to_light; // unit length
    vec3 irradiance; // on a surface that faces the light
};

// Light that arrives at p if all of a rectangle or disc emits from `source`. Other lights have their position
// there.
Incident incidentLight(Light light, vec3 p, vec3 source) {
    if (light.kind == LIGHT_DIRECTIONAL) return Incident(-light.direction, light.color);
    vec3 d = source - p;
    float d2 = max(dot(d, d), 1e-6);
    vec3 l = d * inversesqrt(d2);
    float falloff = 1.0 / d2;
    if (light.kind == LIGHT_SPOT) {
        float t = clamp((dot(-l, light.direction) - light.cos_outer)
            / max(light.cos_inner - light.cos_outer, 1e-4), 0.0, 1.0);
        falloff *= t * t;
    }
    if (isArea(light)) falloff *= areaOf(light) * max(dot(-l, light.direction), 0.0);
    return Incident(l, light.color * falloff);
}

// The same, of a rectangle or disc as a point at its centre.
Incident incidentLight(Light light, vec3 p) {
    return incidentLight(light, p, light.position);
}

#endif
