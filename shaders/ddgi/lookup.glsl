// Light of a surface from the eight probes around it (Majercik et al. 2019): probes behind the
// surface, and those that by their map of distances do not see it, count less.
#ifndef DDGI_LOOKUP_GLSL
#define DDGI_LOOKUP_GLSL
#include "ddgi/probes.glsl"

layout(std430) readonly buffer Placed { Probe list[]; } placed;
uniform sampler2D probeLight;
uniform sampler2D probeDepth;

// Share of the light from a probe that reaches a point, by Chebyshev's inequality.
float visibleFrom(uint probe, vec3 off) {
    float range = length(off);
    vec2 depth = textureLod(probeDepth, placeInAtlas(probe, DEPTH_EDGE, off), 0.0).rg;
    if (range <= depth.x) return 1.0;
    float variance = abs(depth.y - depth.x * depth.x), beyond = range - depth.x;
    float share = variance / (variance + beyond * beyond);
    return max(share * share * share, 0.05);
}

// Mean radiance over the hemisphere of n, and openness. v: to the viewer.
vec4 probeLightAt(vec3 p, vec3 n, vec3 v) {
    vec3 from = p + lookupOffset() * (0.2 * n + 0.8 * v);
    ivec3 last = probeGrid() - 1, first = clamp(ivec3(floor(inProbes(from))), ivec3(0), max(last - 1, 0));
    vec3 part = clamp(inProbes(from) - vec3(first), 0.0, 1.0);
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int i = 0; i < 8; i++) {
        ivec3 corner = ivec3(i & 1, i >> 1 & 1, i >> 2);
        uint probe = probeIndex(min(first + corner, last));
        Probe seen = placed.list[probe];
        if (seen.off == 1) continue;
        vec3 at = gridPoint(probe) + seen.offset, near = mix(1.0 - part, part, vec3(corner));
        float facing = 0.5 * dot(normalize(at - p), n) + 0.5;
        float weight = (facing * facing + 0.2) * visibleFrom(probe, from - at);
        if (weight < 0.2) weight *= weight * weight / 0.04;
        weight *= max(near.x, 0.001) * max(near.y, 0.001) * max(near.z, 0.001);
        sum += weight * textureLod(probeLight, placeInAtlas(probe, LIGHT_EDGE, n), 0.0);
        weights += weight;
    }
    return sum / max(weights, 1e-9);
}

#endif
