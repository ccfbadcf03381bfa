#version 460
#extension GL_GOOGLE_include_directive : require
// The first half of the filter over what pixels of the lattice have gathered: every other one of those in 8x8 pixels. Shading takes
// the mean of 2x2 of what this leaves, so that both together have each pixel of the pattern once, for 20 lookups and not 64.
#include "params.glsl"
#include "common/gbuffer_read.glsl"
#include "shade/filter.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D gatheredDiffuse;
uniform sampler2D gatheredSpecular;
uniform writeonly image2D smoothedDiffuse;
uniform writeonly image2D smoothedSpecular;

void main() {
    ivec2 place = ivec2(gl_GlobalInvocationID.xy), pixel = params.ray_step * place;
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    GBufferSurface seen = gbufferAt(pixel);
    if (!seen.any) {
        imageStore(smoothedDiffuse, place, vec4(0.0, 0.0, 0.0, 1.0));
        imageStore(smoothedSpecular, place, vec4(0.0));
        return;
    }
    Likeness like = likenessOf(seen);
    vec4 diffuse = vec4(0.0);
    vec3 specular = vec3(0.0);
    float weights = 0.0, specular_weights = 0.0, lobe = blurs(seen);
    int stride = 2 * params.ray_step, across = 4 / params.ray_step, first = -(across / 2) * stride;
    for (int y = first; y < first + across * stride; y += stride) {
        for (int x = first; x < first + across * stride; x += stride) {
            ivec2 at = pixel + ivec2(x, y);
            bool own = at == pixel;
            float weight = own ? 1.0 : likeness(at, like);
            diffuse += weight * texelFetch(gatheredDiffuse, at, 0);
            weights += weight;
            weight *= own ? 1.0 : lobe;
            specular += weight * texelFetch(gatheredSpecular, at, 0).rgb;
            specular_weights += weight;
        }
    }
    imageStore(smoothedDiffuse, place, diffuse / weights);
    imageStore(smoothedSpecular, place, vec4(specular / specular_weights, 1.0));
}
