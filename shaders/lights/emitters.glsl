// Emissive triangles, sampled in proportion to their power (luminance times area). Large or textured ones are
// split into parts of constant radiance. Both sides emit, but only the outer sides of closed meshes are
// sampled.
#ifndef EMITTERS_GLSL
#define EMITTERS_GLSL
#include "common/math.glsl"

struct Emitter {
    vec3 a; // world
    float chance; // probability of keeping this entry instead of `other` (alias method, Walker 1977)
    vec3 to_b;
    uint other;
    vec3 to_c;
    uint sides; // sampled sides. 0: both; 1: front, with corners counter-clockwise; 2: back
    vec3 radiance;
    float density; // pdf of samples on it [1/m^2]
};

layout(std430) readonly buffer Emitters {
    uint count; // 0: no emitter samples, only ray hits
    float power;
    uint pad0;
    uint pad1;
    Emitter list[];
} emitters;

// An emitter sample, seen from a point.
struct EmitterSample {
    vec3 direction; // to the sample
    float distance; // [m]
    vec3 radiance;
    float cosine; // to the emitter's normal; 0: not visible
    float by_area; // pdf by area [1/m^2]
};

// Converts a pdf by area to a pdf by solid angle.
float directionDensity(float by_area, float distance, float cosine) {
    return by_area * distance * distance / max(cosine, 1e-6);
}

bool isOuter(uint sides, bool front) {
    return sides == 0 || (sides == 1) == front;
}

// u: four numbers in [0, 1). The scene has at least one emitter.
EmitterSample sampleEmitter(vec3 from, vec4 u) {
    uint index = min(uint(u.x * float(emitters.count)), emitters.count - 1);
    if (u.y >= emitters.list[index].chance) index = emitters.list[index].other;
    Emitter e = emitters.list[index];
    float side = sqrt(u.z);
    vec3 to = e.a - from + side * (1.0 - u.w) * e.to_b + side * u.w * e.to_c;
    float distance = length(to);
    vec3 d = to / max(distance, 1e-20), n = cross(e.to_b, e.to_c);
    float cosine = dot(n, d) / max(length(n), 1e-20);
    bool seen = distance > 0.0 && abs(cosine) > 1e-6 && isOuter(e.sides, cosine < 0.0);
    return EmitterSample(d, distance, e.radiance, seen ? abs(cosine) : 0.0, e.density);
}

// Pdf of an emitter sample at a ray hit [1/m^2]. flags: index of the first part plus 1; from bit 24, the
// number of parts along an edge.
float emitterDensity(uint flags, vec2 weights, bool front) {
    uint first = flags & 0xffffffu, parts = flags >> 24 & 0x7fu;
    if (first == 0 || emitters.count == 0) return 0.0;
    vec2 at = weights * float(parts);
    uvec2 part = min(uvec2(at), uvec2(parts - 1));
    vec2 within = at - vec2(part);
    part.x = min(part.x, parts - 1 - part.y);
    uint upper = within.x + within.y > 1.0 && part.x + part.y + 1 < parts ? 1u : 0u;
    uint index = first - 1 + part.y * (2 * parts - part.y) + 2 * part.x + upper;
    return isOuter(emitters.list[index].sides, front) ? emitters.list[index].density : 0.0;
}

#endif
