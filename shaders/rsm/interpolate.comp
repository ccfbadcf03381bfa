#version 460
#extension GL_GOOGLE_include_directive : require
// Light of every pixel: interpolated between the four nearest that have gathered, where most of them see
// the same surface; else gathered.
#include "params.glsl"
#include "gbuffer/read.glsl"
#include "shade/filter.glsl"
#include "rsm/gather.glsl"
#include "rsm/spacing.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D rsmSparse;
uniform writeonly image2D gatheredDiffuse;

// Share of the bilinear weights that must see the same surface.
const float ENOUGH = 0.5;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    GBufferSurface seen = gbufferAt(pixel);
    if (!seen.any) {
        imageStore(gatheredDiffuse, pixel, vec4(0.0, 0.0, 0.0, 1.0));
        return;
    }
    EdgeStop stop = edgeStopOf(pixel, seen);
    vec2 place = (vec2(pixel) - float(params.rsm_spacing / 2)) / float(params.rsm_spacing);
    ivec2 first = ivec2(floor(place));
    vec2 part = place - vec2(first);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        ivec2 corner = ivec2(i & 1, i >> 1), at = clamp(first + corner, ivec2(0), sparseSize() - 1);
        vec2 near = mix(1.0 - part, part, vec2(corner));
        sum += near.x * near.y * filterWeights(pixelOf(at), stop).diffuse * texelFetch(rsmSparse, at, 0);
    }
    vec3 light = sum.a >= ENOUGH ? sum.rgb / sum.a : rsmLight(seen.position, seen.surface.normal);
    imageStore(gatheredDiffuse, pixel, vec4(light, 1.0));
}
