#version 460
#extension GL_GOOGLE_include_directive : require
// The first half of the filter over what pixels have gathered: every other pixel of 8x8. Shading takes the mean of 2x2 of what
// this leaves, so that both together have each pixel of the pattern once, for 20 lookups and not 64.
#include "params.glsl"
#include "common/gbuffer_read.glsl"
#include "shade/filter.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform writeonly image2D smoothedDiffuse;
uniform writeonly image2D smoothedSpecular;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    GBufferSurface seen = gbufferAt(pixel);
    Filtered light = Filtered(vec4(0.0, 0.0, 0.0, 1.0), vec3(0.0));
    if (seen.any) light = filterGathered(pixel, seen, -4, 2, 4);
    imageStore(smoothedDiffuse, pixel, light.hemisphere);
    imageStore(smoothedSpecular, pixel, vec4(light.specular, 1.0));
}
