#version 460
#extension GL_GOOGLE_include_directive : require
// How much of the light around a surface its specular lobe reflects to the viewer: f0 * r + f90 * g, for roughness and the
// cosine at the viewer. Integrated from the BRDF that shading uses, so that light from cones and from lamps agree.
#include "params.glsl"
#include "common/ggx.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform writeonly image2D specularAlbedo; // x: root of the cosine, y: roughness

const int SAMPLES = 128;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(specularAlbedo);
    if (any(greaterThanEqual(at, size))) return;
    vec2 x = vec2(at) / vec2(size - 1);
    float cosine = max(x.x * x.x, 1e-3);
    vec3 v = vec3(sqrt(1.0 - cosine * cosine), 0.0, cosine), n = vec3(0, 0, 1);
    Surface none = makeSurface(n, vec3(0.0), x.y, 1.0, PLAIN_DIELECTRIC), all = makeSurface(n, vec3(1.0), x.y, 1.0, PLAIN_DIELECTRIC); // f0 0 and 1
    vec2 sum = vec2(0.0);
    for (int i = 0; i < SAMPLES; i++) {
        vec2 u = fract(0.5 + float(i) * vec2(0.7548776662, 0.5698402910)); // Roberts 2018, R2
        sum += vec2(specularSample(all, n, v, u).weight.r, specularSample(none, n, v, u).weight.r);
    }
    sum /= float(SAMPLES);
    imageStore(specularAlbedo, at, vec4(sum.x - sum.y, sum.y, 0.0, 0.0));
}
