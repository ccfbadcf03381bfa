#version 460
#extension GL_GOOGLE_include_directive : require
// Light and openness of each pixel from slices of the depth buffer (Therrien, Levesque and Gagnon 2023,
// "Screen Space Indirect Lighting with Visibility Bitmask").
#include "params.glsl"
#include "gbuffer/read.glsl"
#include "gbuffer/motion.glsl"
#include "common/pattern.glsl"
#include "common/random.glsl"
#include "ssgi/slice.glsl"

// Light of a direction that meets nothing in the picture; `spread`: solid angle that it represents [sr].
vec3 missedLight(GBufferSurface seen, vec3 d, float spread, inout float open);
// Light of emitter samples, if the picture's light does not include emission.
vec3 emitterLight(GBufferSurface seen, uint number);
#include "modules/screen_miss.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D lastScreenLight;
uniform writeonly image2D screenGathered;

// Radiance that left the surface at a pixel in the last frame; 0 if it was not in the picture.
vec3 lightFrom(ivec2 at, vec3 p) {
    vec4 clip = camera.previous_view_projection * vec4(p - motionAt(at), 1.0);
    if (clip.w <= 0.0) return vec3(0.0);
    ivec2 before = ivec2(floor((clip.xy / clip.w * 0.5 + 0.5) * vec2(camera.size)));
    if (any(greaterThanEqual(uvec2(before), uvec2(camera.size)))) return vec3(0.0);
    vec4 light = texelFetch(lastScreenLight, before, 0);
    float range = distance(p, camera.previous_position);
    return abs(light.a - range) < 0.05 * range ? light.rgb : vec3(0.0);
}

// Marches along one side of a slice and adds the light of the sectors that it closes.
void march(Slice s, GBufferSurface seen, ivec2 pixel, vec2 step, vec2 jitter, inout uint closed,
    inout vec3 light) {
    float reach = params.ssgi_radius * float(camera.size.y);
    for (int i = 0; i < params.ssgi_steps; i++) {
        float part = (float(i) + jitter.x) / float(params.ssgi_steps);
        ivec2 at = pixel + ivec2(round(step * (1.0 + reach * part * part)));
        if (any(greaterThanEqual(uvec2(at), uvec2(camera.size)))) return;
        float range = texelFetch(gbufferDistance, at, 0).r;
        if (range <= 0.0) continue;
        vec3 ray = pixelRay(at), p = camera.position + range * ray, off = p - seen.position;
        float near = sectorOf(s, angleOf(s, off)),
            behind = sectorOf(s, angleOf(s, off + params.ssgi_thickness * range * ray));
        uint sectors = sectorsBetween(min(near, behind), max(near, behind), jitter.y);
        uint fresh = sectors & ~closed;
        closed |= sectors;
        if (fresh == 0u) continue;
        vec3 face = unpackNormal(texelFetch(gbufferNormals, at, 0).zw);
        if (dot(face, ray) > 0.0) face = -face;
        if (dot(face, off) < 0.0) light += float(bitCount(fresh)) / SECTORS * lightFrom(at, p);
    }
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    GBufferSurface seen = gbufferAt(pixel);
    if (!seen.any) {
        imageStore(screenGathered, pixel, vec4(0.0, 0.0, 0.0, 1.0));
        return;
    }
    vec3 sum = vec3(0.0);
    float open = 0.0;
    for (int i = 0; i < params.ssgi_slices; i++) {
        uint number = uint(i) * 64u + patternIndex(uvec2(pixel));
        vec2 u = r2(number);
        Random random = Random(uvec4(uvec2(pixel & 7), number, 0u));
        vec4 more = next4(random);
        float turn = PI * (float(i) + u.x) / float(params.ssgi_slices);
        vec2 step = vec2(cos(turn), sin(turn));
        vec3 along = transpose(mat3(camera.view))
            * vec3(step / vec2(camera.projection[0][0], camera.projection[1][1]) / vec2(camera.size), 0.0);
        Slice s = sliceOf(seen.surface.normal, seen.to_viewer, along);
        uint closed = 0u;
        vec3 light = vec3(0.0);
        march(s, seen, pixel, step, vec2(u.y, more.x), closed, light);
        march(s, seen, pixel, -step, vec2(u.y, more.x), closed, light);
        int left = bitCount(~closed);
        if (left > 0) {
            float sector = float(nthBit(~closed, min(int(more.y * float(left)), left - 1))) + more.z;
            float share = float(left) / SECTORS, seen_through = 1.0;
            vec3 d = directionAt(s, sector);
            if (dot(d, seen.face) > 0.0) {
                float spread = PI * share / float(params.ssgi_slices);
                light += share * missedLight(seen, d, spread, seen_through);
                open += s.weight * share * seen_through;
            }
        }
        sum += s.weight * light + emitterLight(seen, number);
    }
    imageStore(screenGathered, pixel, vec4(sum, open) / float(params.ssgi_slices));
}
