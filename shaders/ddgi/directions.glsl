// Directions of a probe's rays: a Fibonacci sphere that turns by chance in each frame, then one that
// stays.
#ifndef DDGI_DIRECTIONS_GLSL
#define DDGI_DIRECTIONS_GLSL
#include "common/math.glsl"
#include "common/random.glsl"
#include "common/scene.glsl"

vec3 fibonacci(int i, int count) {
    float turn = 2.0 * PI * fract(float(i) * 0.6180339887);
    float z = 1.0 - (2.0 * float(i) + 1.0) / float(count);
    float side = sqrt(max(1.0 - z * z, 0.0));
    return vec3(cos(turn) * side, sin(turn) * side, z);
}

// A random rotation (Shoemake 1992), the same for all probes of a frame.
vec3 turned(vec3 v) {
    Random random = Random(uvec4(camera.frame, 0u, 0u, 0u));
    vec4 u = next4(random);
    vec2 a = 2.0 * PI * u.yz;
    vec4 q = vec4(sqrt(1.0 - u.x) * vec2(sin(a.x), cos(a.x)), sqrt(u.x) * vec2(sin(a.y), cos(a.y)));
    return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v);
}

vec3 rayDirection(int ray) {
    return ray < params.probe_rays ? turned(fibonacci(ray, params.probe_rays))
        : fibonacci(ray - params.probe_rays, params.probe_fixed_rays);
}

#endif
