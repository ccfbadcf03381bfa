#version 460
#extension GL_GOOGLE_include_directive : require
// Adds a frame's rays to the two maps of a probe (Majercik et al. 2019), borders included.
// Light is weighted by the cosine, distance by its 50th power.
#include "params.glsl"
#include "ddgi/probes.glsl"
#include "ddgi/directions.glsl"

layout(local_size_x = 128) in;

layout(std430) readonly buffer LastProbes { Probe list[]; } lastProbes;
layout(std430) readonly buffer ProbeRays { vec4 list[]; } probeRays;
uniform sampler2D lastProbeLight;
uniform sampler2D lastProbeDepth;
uniform writeonly image2D probeLight;
uniform writeonly image2D probeDepth;

const int MOST_RAYS = 256;
const float SHARPNESS = 50.0;

shared vec4 shared_light[MOST_RAYS]; // radiance, openness
shared vec4 shared_ways[MOST_RAYS]; // direction, distance up to the limit

void main() {
    uint probe = gl_WorkGroupID.x;
    int lane = int(gl_LocalInvocationIndex), stride = params.probe_rays + params.probe_fixed_rays;
    bool off = lastProbes.list[probe].off == 1;
    for (int i = lane; i < params.probe_rays && !off; i += 128) {
        vec4 ray = probeRays.list[probe * stride + i];
        shared_light[i] = vec4(ray.rgb, ray.a >= 1e30 ? 1.0 : 0.0);
        shared_ways[i] = vec4(rayDirection(i), min(abs(ray.a), depthLimit()));
    }
    barrier();
    // Frames since the start have equal weights until the hysteresis is reached.
    float fresh = max(1.0 - params.probe_hysteresis, 1.0 / float(1 + camera.frame));
    int light_texels = (LIGHT_EDGE + 2) * (LIGHT_EDGE + 2),
        depth_texels = (DEPTH_EDGE + 2) * (DEPTH_EDGE + 2);
    for (int i = lane; i < light_texels + depth_texels; i += 128) {
        bool lights = i < light_texels;
        int edge = lights ? LIGHT_EDGE : DEPTH_EDGE, number = lights ? i : i - light_texels;
        ivec2 texel = ivec2(number % (edge + 2), number / (edge + 2)), at = tileOf(probe, edge) + texel;
        vec3 d = directionOf(texel, edge);
        vec4 sum = vec4(0.0);
        float weights = 0.0;
        for (int k = 0; k < params.probe_rays && !off; k++) {
            vec4 way = shared_ways[k];
            float weight = max(dot(d, way.xyz), 0.0);
            if (!lights) weight = pow(weight, SHARPNESS);
            sum += weight * (lights ? shared_light[k] : vec4(way.w, way.w * way.w, 0.0, 0.0));
            weights += weight;
        }
        vec4 last = lights ? texelFetch(lastProbeLight, at, 0) : texelFetch(lastProbeDepth, at, 0);
        vec4 now = weights > 1e-6 ? mix(last, sum / weights, fresh) : last;
        if (lights) imageStore(probeLight, at, min(now, 60000.0));
        else imageStore(probeDepth, at, now);
    }
}
