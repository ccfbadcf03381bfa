#version 460
#extension GL_GOOGLE_include_directive : require
// Light of the pixels.
#include "params.glsl"
#include "gbuffer/read.glsl"
#include "ddgi/lookup.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform writeonly image2D gatheredDiffuse;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    GBufferSurface seen = gbufferAt(pixel);
    vec4 light = vec4(0.0, 0.0, 0.0, 1.0);
    if (seen.any) light = probeLightAt(seen.position, seen.surface.normal, seen.to_viewer);
    imageStore(gatheredDiffuse, pixel, light);
}
