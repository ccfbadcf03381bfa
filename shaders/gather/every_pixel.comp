#version 460
#extension GL_GOOGLE_include_directive : require
// Gathers with a full set of cones for every pixel in every frame.
#include "params.glsl"
#include "gather/pixel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

vec2 pixelCentre() {
    return vec2(gl_GlobalInvocationID.xy) + 0.5;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    GBufferSurface seen = gbufferAt(pixel);
    Gathered light = NOTHING_GATHERED;
    if (seen.any) {
        ConeOrigin origin = coneOrigin(seen.position, seen.face, seen.surface.normal);
        light = gather(origin, seen.surface, seen.face, seen.to_viewer);
    }
    imageStore(gatheredDiffuse, pixel, light.hemisphere);
    imageStore(gatheredSpecular, pixel, vec4(light.specular, 0.0));
}
