#version 460
#extension GL_GOOGLE_include_directive : require
// Radiance that leaves each pixel's surface, as if it were diffuse: emission, and the direct and gathered
// light that it reflects.
#include "params.glsl"
#include "gbuffer/read.glsl"
#include "shadow/visibility.glsl"
#include "lights/direct.glsl"
#include "shade/lobe_albedo.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D gatheredDiffuse;
uniform writeonly image2D screenLight;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    GBufferSurface seen = gbufferAt(pixel);
    if (!seen.any) {
        imageStore(screenLight, pixel, vec4(0.0));
        return;
    }
    Surface diffuse = seen.surface;
    diffuse.albedo = min(diffuse.albedo + lobeReflectance(diffuse, seen.to_viewer), 1.0);
    diffuse.f0 = vec3(0.0);
    diffuse.f90 = 0.0;
    vec3 light = float(params.screen_emits) * seen.emission + diffuse.albedo * texelFetch(gatheredDiffuse, pixel, 0).rgb
        + directLight(diffuse, seen.position, seen.face, seen.to_viewer);
    imageStore(screenLight, pixel, vec4(min(light, 60000.0), distance(seen.position, camera.position)));
}
