// G-buffer lookups.
#ifndef GBUFFER_READ_GLSL
#define GBUFFER_READ_GLSL
#include "common/scene.glsl"
#include "common/brdf.glsl"
#include "gbuffer/packing.glsl"
#include "materials/dielectrics.glsl"
#include "common/pixel.glsl"

struct GBufferSurface {
    bool any; // false: background
    vec3 position;
    vec3 face; // geometric normal
    vec3 to_viewer;
    Surface surface;
    vec3 emission;
};

uniform sampler2D gbufferBase; // base colour, roughness
uniform sampler2D gbufferNormals; // packed: shading, geometric
uniform sampler2D gbufferEmission; // radiance, metallic with the dielectric's index
uniform sampler2D gbufferDistance; // from the camera [m]; 0: background

GBufferSurface gbufferAt(ivec2 pixel) {
    GBufferSurface seen;
    float range = texelFetch(gbufferDistance, pixel, 0).r;
    seen.any = range > 0.0;
    if (!seen.any) return seen;
    vec3 ray = pixelRay(pixel);
    vec4 base = texelFetch(gbufferBase, pixel, 0), normals = texelFetch(gbufferNormals, pixel, 0);
    vec4 emission = texelFetch(gbufferEmission, pixel, 0);
    seen.position = camera.position + range * ray;
    seen.to_viewer = -ray;
    seen.face = unpackNormal(normals.zw);
    if (dot(seen.face, ray) > 0.0) seen.face = -seen.face;
    vec3 normal = unpackNormal(normals.xy);
    if (dot(normal, seen.face) < -0.5) normal = -normal; // mapped normals lean, mixtures may point anywhere
    uint index;
    float metallic = unpackMetallic(emission.a, index);
    vec4 dielectric = index == 0u ? PLAIN_DIELECTRIC : dielectrics.list[index];
    seen.surface = makeSurface(normal, base.rgb, base.a, metallic, dielectric, seen.to_viewer);
    seen.emission = emission.rgb;
    return seen;
}

#endif
