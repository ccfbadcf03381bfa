#version 460
#extension GL_GOOGLE_include_directive : require
// Directional albedo of the specular lobe, f0 * r + f90 * g, by roughness and cosine at the viewer.
// Integrated from the BRDF of shading, so that light from cones and from lamps agrees. One group per texel:
// 1,024 samples are within 0.3 % of 65,536.
#include "params.glsl"
#include "common/ggx.glsl"

const uint THREADS = 64, SAMPLES = 1024;

layout(local_size_x = 64) in;

uniform writeonly image2D table; // x: root of the cosine, y: roughness

shared vec2 sums[THREADS];

void main() {
    uvec2 at = gl_WorkGroupID.xy;
    uint thread = gl_LocalInvocationID.x;
    vec2 x = vec2(at) / vec2(imageSize(table) - 1);
    float cosine = max(x.x * x.x, 1e-3);
    vec3 v = vec3(sqrt(1.0 - cosine * cosine), 0.0, cosine), n = vec3(0, 0, 1);
    Surface none = bareSurface(n, vec3(0.0), x.y, 1.0, PLAIN_DIELECTRIC); // f0 = 0
    Surface all = bareSurface(n, vec3(1.0), x.y, 1.0, PLAIN_DIELECTRIC); // f0 = 1
    vec2 sum = vec2(0.0);
    for (uint i = thread; i < SAMPLES; i += THREADS) {
        vec2 u = fract(0.5 + float(i) * vec2(0.7548776662, 0.5698402910)); // Roberts 2018, R2
        sum += vec2(specularSample(all, n, v, u).weight.r, specularSample(none, n, v, u).weight.r);
    }
    sums[thread] = sum;
    for (uint half_way = THREADS / 2; half_way > 0; half_way /= 2) {
        barrier();
        if (thread < half_way) sums[thread] += sums[thread + half_way];
    }
    if (thread > 0) return;
    sum = sums[0] / float(SAMPLES);
    imageStore(table, ivec2(at), vec4(sum.x - sum.y, sum.y, 0.0, 0.0));
}
