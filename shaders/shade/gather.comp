#version 460
#extension GL_GOOGLE_include_directive : require
// What the cones of each pixel gather, to be filtered and reflected by shading.
#include "params.glsl"
#include "common/gbuffer_read.glsl"
#include "modules/trace.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform writeonly image2D gatheredDiffuse; // mean radiance over the hemisphere; a: how open it is
uniform writeonly image2D gatheredSpecular; // radiance towards the viewer

vec2 pixelCentre() {
    return vec2(gl_GlobalInvocationID.xy) + 0.5;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    GBufferSurface seen = gbufferAt(pixel);
    Gathered light = Gathered(vec4(0.0, 0.0, 0.0, 1.0), vec3(0.0));
    if (seen.any) light = gather(coneOrigin(seen.position, seen.face, seen.surface.normal), seen.surface, seen.face, seen.to_viewer);
    imageStore(gatheredDiffuse, pixel, light.hemisphere);
    imageStore(gatheredSpecular, pixel, vec4(light.specular, 1.0));
}
