// Final deferred shading, one thread per pixel and one image per light component (thesis, Algorithm 3).
// Indirect diffuse light is albedo times the mean radiance over the hemisphere, including the sky in open
// directions.
#include "params.glsl"
#include "gbuffer/read.glsl"
#include "shadow/visibility.glsl"
#include "lights/direct.glsl"
#include "lights/sky.glsl"
#include "shade/filter.glsl"
#include "shade/demodulate.glsl"
#include "modules/gathered_light.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform writeonly image2D sampledRadiance; // total, including emission
uniform writeonly image2D sampledDirect;
uniform writeonly image2D sampledDiffuse;
uniform writeonly image2D sampledSpecular;
uniform writeonly image2D sampledOpenness; // 1: open
uniform writeonly image2D surfaceNormal; // * 0.5 + 0.5

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    GBufferSurface seen = gbufferAt(pixel);
    vec3 total = vec3(0.0), normal = vec3(-1.0), lit = vec3(0.0), diffuse = vec3(0.0);
    Filtered light = Filtered(vec4(0.0, 0.0, 0.0, 1.0), vec3(0.0));
    if (seen.any) {
        light = gatheredLight(pixel, seen);
        lit = directLight(seen.surface, seen.position, seen.face, seen.to_viewer);
        diffuse = seen.surface.albedo * light.hemisphere.rgb;
        total = lit + diffuse + light.specular + seen.emission;
        normal = seen.surface.normal;
    } else {
        total = skyBehind(pixelRay(pixel));
    }
    float covered = seen.any ? 1.0 : 0.0;
    imageStore(sampledRadiance, pixel, vec4(total, 1.0));
    imageStore(sampledDirect, pixel, vec4(lit, covered));
    imageStore(sampledDiffuse, pixel, vec4(diffuse, covered));
    imageStore(sampledSpecular, pixel, vec4(light.specular, covered));
    imageStore(sampledOpenness, pixel, vec4(vec3(light.hemisphere.a), 1.0));
    imageStore(surfaceNormal, pixel, vec4(normal * 0.5 + 0.5, covered));
}
