#version 460
#extension GL_GOOGLE_include_directive : require
// Moves probes out of walls and away from surfaces, and turns off those that stay inside or that no
// surface needs (Majercik et al. 2021, "Scaling Probe-Based Real-Time Dynamic Global Illumination for
// Production").
#include "params.glsl"
#include "ddgi/probes.glsl"
#include "ddgi/directions.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer LastProbes { Probe list[]; } lastProbes;
layout(std430) writeonly buffer Probes { Probe list[]; } probes;
layout(std430) readonly buffer ProbeRays { vec4 list[]; } probeRays;
layout(std430) readonly buffer ProbeNeeded { uint list[]; } probeNeeded;

// Share of back faces from which a probe is inside, least distance of a surface and largest offset
// [spacings], and frames after a change in which probes move.
const float INSIDE = 0.25, CLEARANCE = 0.2, REACH = 0.45;
const uint MOVING_FRAMES = 12;

void main() {
    uint probe = gl_GlobalInvocationID.x;
    if (probe >= params.probe_count) return;
    Probe placed = lastProbes.list[probe];
    uint first = probe * (params.probe_rays + params.probe_fixed_rays) + params.probe_rays;
    float backs = 0.0, back = 1e30, front = 1e30, far = 0.0;
    vec3 to_back = vec3(0.0), to_front = vec3(0.0), to_far = vec3(0.0);
    for (int i = 0; i < params.probe_fixed_rays; i++) {
        float range = probeRays.list[first + i].a;
        vec3 d = rayDirection(params.probe_rays + i);
        if (range < 0.0) {
            backs += 1.0;
            if (-range < back) {
                back = -range;
                to_back = d;
            }
            continue;
        }
        if (range < front) {
            front = range;
            to_front = d;
        }
        if (range > far) {
            far = range;
            to_far = d;
        }
    }
    float clearance = CLEARANCE * params.probe_spacing;
    bool inside = backs > INSIDE * float(params.probe_fixed_rays);
    if (PROBE_MOVES == PROBE_MOVES_ON && camera.still_frames < MOVING_FRAMES) {
        vec3 moved = placed.offset;
        if (inside) moved += (back + 0.5 * clearance) * to_back;
        else if (front < clearance && dot(to_front, to_far) <= 0.0)
            moved += min(clearance - front, 0.5 * far) * to_far;
        if (all(lessThan(abs(moved), vec3(REACH * params.probe_spacing)))) placed.offset = moved;
    }
    placed.off = inside || probeNeeded.list[probe] == 0 ? 1 : 0;
    probes.list[probe] = placed;
}
