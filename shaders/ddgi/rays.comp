#version 460
#extension GL_GOOGLE_include_directive : require
// Rays of the probes. Probes that are off trace only those that tell whether they still are.
#include "params.glsl"
#include "cones/origin.glsl"
#include "surfels/trace.glsl"
#include "lights/sky.glsl"
#include "ddgi/probes.glsl"
#include "ddgi/directions.glsl"

layout(local_size_x = 32, local_size_y = 2) in;

layout(std430) readonly buffer LastProbes { Probe list[]; } lastProbes;
// Radiance and distance [m]. Below 0: of a back face; 1e30: the sky.
layout(std430) writeonly buffer ProbeRays { vec4 list[]; } probeRays;

// Whether a side has no surface of its own: a ray hit the back of a triangle.
bool isBack(uint side) {
    return (surfels.quads[surfelBase(side / SIDES) >> 2].x >> 30 >> (side % SIDES) & 1u) == 0;
}

void main() {
    int ray = int(gl_GlobalInvocationID.x), rays = params.probe_rays + params.probe_fixed_rays;
    uint probe = gl_GlobalInvocationID.y;
    if (ray >= rays || probe >= params.probe_count) return;
    Probe placed = lastProbes.list[probe];
    if (placed.off == 1 && ray < params.probe_rays) return;
    vec3 p = gridPoint(probe) + placed.offset, d = rayDirection(ray);
    int cascade = cascadeAt(p);
    SurfelHit met = traceSurfels(ConeOrigin(p, vec3(0.0), 0.0, 0.0, cascade, p, 1.0), d, 1e30);
    vec4 found = vec4(skyRadiance(d, 4.0 * PI / float(params.probe_rays)), 1e30);
    if (met.light.a > 0.0) found = vec4(met.light.rgb, isBack(met.side) ? -met.distance : met.distance);
    probeRays.list[probe * rays + ray] = found;
}
