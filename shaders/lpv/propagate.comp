#version 460
#extension GL_GOOGLE_include_directive : require
// Each cell takes what its six neighbours send through its faces, as flux that leaves it at these faces
// again (Kaplanyan and Dachsbacher 2010). Their flux lacks the factor of 4 pi that makes it
// equal to what the neighbours lose.
#include "params.glsl"
#include "lpv/grid.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430) readonly buffer LpvBlockers { int coefficients[]; } lpvBlockers;
layout(std430) buffer LpvWaves { vec4 coefficients[]; } lpvWaves;
layout(std430) buffer LpvSums { vec4 coefficients[]; } lpvSums;

// Solid angles of the far face and of a side face, from the neighbour's centre [sr].
const float FAR_FACE = 0.4006697, SIDE_FACE = 0.4234414;

vec3 axisDirection(int i) {
    return ((i & 1) == 0 ? 1.0 : -1.0) * vec3(equal(ivec3(i >> 1), ivec3(0, 1, 2)));
}

// Blockers at the four corners of the face between a cell and the one before it along d: the larger of
// what lights and what the camera see.
vec4 blockersAt(ivec3 cell, ivec3 d, int grid) {
    vec4 sum = vec4(0.0);
    ivec3 axis = abs(d), first = cell + max(-d, ivec3(0));
    for (int i = 0; i < 4; i++) {
        ivec3 corner = first + (axis.x == 1 ? ivec3(0, i & 1, i >> 1)
            : axis.y == 1 ? ivec3(i & 1, 0, i >> 1)
            : ivec3(i & 1, i >> 1, 0));
        uint at = 8u * indexIn(params.lpv_dim + 1, corner, grid);
        uint seen = lpvBlockers.coefficients[at] >= lpvBlockers.coefficients[at + 4] ? at : at + 4;
        for (int k = 0; k < 4; k++) sum[k] += float(lpvBlockers.coefficients[seen + k]);
    }
    return sum / (4.0 * BLOCKER_UNIT);
}

void main() {
    ivec3 stored = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(stored.xy, ivec2(params.lpv_dim)))) return;
    int grid = stored.z / params.lpv_dim;
    ivec3 cell = ivec3(stored.xy, stored.z % params.lpv_dim);
    uint from = (pass.index & 1u) * uint(params.lpv_cells), to = uint(params.lpv_cells) - from;
    mat3x4 light = mat3x4(0.0);
    for (int i = 0; i < 6; i++) {
        vec3 d = axisDirection(i);
        ivec3 neighbour = cell - ivec3(d);
        if (!inGrid(neighbour)) continue;
        uint at = 3u * (from + indexIn(params.lpv_dim, neighbour, grid));
        mat3x4 sent = mat3x4(lpvWaves.coefficients[at], lpvWaves.coefficients[at + 1],
            lpvWaves.coefficients[at + 2]);
        if (sent == mat3x4(0.0)) continue;
        vec4 blockers = LPV_BLOCKING == LPV_BLOCKING_ON ? blockersAt(cell, ivec3(d), grid) : vec4(0.0);
        for (int f = 0; f < 6; f++) {
            if (f == (i ^ 1)) continue; // where the light comes in
            vec3 face = axisDirection(f), way = normalize(d + 0.5 * face);
            float blocked = max(dot(blockers, harmonics(way)), dot(blockers, harmonics(-way)));
            float passed = (f == i ? FAR_FACE : SIDE_FACE) * (1.0 - clamp(blocked, 0.0, 1.0));
            vec3 flux = passed * max(harmonics(way) * sent, 0.0);
            vec4 lobe = cosineLobe(face) / PI;
            light += mat3x4(flux.r * lobe, flux.g * lobe, flux.b * lobe);
        }
    }
    uint own = 3u * indexIn(params.lpv_dim, cell, grid);
    for (int channel = 0; channel < 3; channel++) {
        lpvWaves.coefficients[3u * to + own + channel] = light[channel];
        lpvSums.coefficients[own + channel] += light[channel];
    }
}
