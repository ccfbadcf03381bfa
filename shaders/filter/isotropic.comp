#version 460
#extension GL_GOOGLE_include_directive : require
// Computes one mip of the radiance from the finer one (thesis, Section 4.4). Texels are premultiplied by
// opacity, so a plain mean is correct. Odd sizes use three taps per axis, weighted like the exact box.
#include "params.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;

uniform sampler3D src; // one mip, border clamped
uniform writeonly image3D dst;

// Weights of texels 2i, 2i + 1 and 2i + 2 in texel i, for a row of n texels halved to m.
vec3 boxWeights(int i, int n, int m) {
    if (n == 2 * m) return vec3(0.5, 0.5, 0.0);
    return n == 1 ? vec3(1.0, 0.0, 0.0) : vec3(float(m - i), float(m), float(i + 1)) / float(n);
}

vec4 box(ivec3 cell, ivec3 n, ivec3 m) {
    vec3 x = boxWeights(cell.x, n.x, m.x), y = boxWeights(cell.y, n.y, m.y), z = boxWeights(cell.z, n.z, m.z);
    ivec3 taps = mix(ivec3(3), ivec3(2), equal(n, 2 * m));
    vec4 sum = vec4(0.0);
    for (int k = 0; k < taps.z; k++)
        for (int j = 0; j < taps.y; j++)
            for (int i = 0; i < taps.x; i++)
                sum += x[i] * y[j] * z[k] * texelFetch(src, min(2 * cell + ivec3(i, j, k), n - 1), 0);
    return sum;
}

void main() {
    ivec3 cell = ivec3(gl_GlobalInvocationID);
    ivec3 m = imageSize(dst), n = textureSize(src, 0);
    if (any(greaterThanEqual(cell, m))) return;
    vec4 value;
    if (all(equal(n, 2 * m)))
        value = textureLod(src, (vec3(cell) + 0.5) / vec3(m), 0.0); // mean of 8 texels by the texture unit
    else value = box(cell, n, m);
    imageStore(dst, cell, value);
}
