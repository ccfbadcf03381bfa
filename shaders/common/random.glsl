// Counter-based random numbers: a number depends only on its key, so samples may be taken in any order, in
// parts, and on any machine.
#ifndef RANDOM_GLSL
#define RANDOM_GLSL

struct Random {
    uvec4 key; // pixel, sample, draw, seed
};

// pcg4d (Jarzynski and Olano 2020, "Hash Functions for GPU Rendering").
uvec4 hash4(uvec4 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> 16u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// Four numbers in [0, 1), 24 bits each.
vec4 next4(inout Random r) {
    r.key.z++;
    return vec4(hash4(r.key) >> 8u) * (1.0 / 16777216.0);
}

#endif
