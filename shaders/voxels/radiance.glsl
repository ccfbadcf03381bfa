// Packed radiance.
#ifndef VOXEL_RADIANCE_GLSL
#define VOXEL_RADIANCE_GLSL

// Nine bits per channel and a shared exponent (EXT_texture_shared_exponent), up to 65408.
uint packRadiance(vec3 c) {
    c = clamp(c, 0.0, 65408.0);
    float largest = max(c.r, max(c.g, c.b));
    if (largest < 1e-6) return 0;
    int exponent = clamp(int(floor(log2(largest))) + 16, 0, 31);
    if (largest / exp2(float(exponent - 24)) >= 511.5) exponent = min(exponent + 1, 31);
    uvec3 v = uvec3(c / exp2(float(exponent - 24)) + 0.5);
    return v.r | v.g << 9 | v.b << 18 | uint(exponent) << 27;
}

vec3 unpackRadiance(uint w) {
    return vec3(w & 511u, w >> 9 & 511u, w >> 18 & 511u) * exp2(float(w >> 27) - 24.0);
}

#endif
