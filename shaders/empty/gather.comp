#version 460
#extension GL_GOOGLE_include_directive : require
// No indirect light.
#include "params.glsl"
#include "gbuffer/read.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform writeonly image2D gatheredDiffuse;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    GBufferSurface seen = gbufferAt(pixel);
    vec4 light = vec4(0.0, 0.0, 0.0, 1.0); // mean radiance over the hemisphere, openness
    if (seen.any) light.rgb = vec3(0.0); // from seen.position, seen.face and seen.surface
    imageStore(gatheredDiffuse, pixel, light);
}
