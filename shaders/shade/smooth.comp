#version 460
#extension GL_GOOGLE_include_directive : require
// First half of the filter over gathered light: the mean of every other pixel in 8x8. Shading averages 2x2 of
// these means. Together they read each pixel of the pattern once, with 20 lookups instead of 64.
#include "params.glsl"
#include "gbuffer/read.glsl"
#include "shade/filter.glsl"
#include "history/rounds.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D gatheredDiffuse;
uniform sampler2D gatheredSpecular; // a: age and rounds, see history/rounds.glsl
uniform sampler2D gatherChange;
uniform writeonly image2D smoothedDiffuse;
uniform writeonly image2D smoothedSpecular;

// Weight of light of an age: less if it is older than the last change. If changes last, light lacks those of
// the frames since it was gathered, and likewise the bounces that follow a change.
float currency(float age, vec4 change) {
    age = mod(age, float(AGES));
    float phases = float(params.phases), still = change.y, changing = max(change.z, 1.0);
    float missed = max(clamp((age - still) / changing, 0.0, 1.0), age / phases * still / phases);
    return 1.0 / (1.0 + change.x * missed * missed);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    GBufferSurface seen = gbufferAt(pixel);
    if (!seen.any) {
        imageStore(smoothedDiffuse, pixel, vec4(0.0, 0.0, 0.0, 1.0));
        imageStore(smoothedSpecular, pixel, vec4(0.0));
        return;
    }
    EdgeStop stop = edgeStopOf(pixel, seen);
    vec4 diffuse = vec4(0.0);
    vec3 specular = vec3(0.0);
    float diffuse_weights = 0.0, specular_weights = 0.0, surface_weights = 0.0;
    vec2 tile = (vec2(pixel) + 0.5) / vec2(8 * textureSize(gatherChange, 0));
    vec4 change = textureLod(gatherChange, tile, 0.0);
    for (int i = 0; i < 16; i++) {
        ivec2 at = pixel + 2 * (ivec2(i & 3, i >> 2) - 2);
        FilterWeights weights = filterWeights(at, stop);
        vec4 light = texelFetch(gatheredSpecular, at, 0);
        float current = currency(light.a, change);
        surface_weights += weights.diffuse;
        weights.diffuse *= current;
        weights.specular *= current;
        diffuse += weights.diffuse * texelFetch(gatheredDiffuse, at, 0);
        specular += weights.specular * light.rgb;
        diffuse_weights += weights.diffuse;
        specular_weights += weights.specular;
    }
    imageStore(smoothedDiffuse, pixel, diffuse / diffuse_weights);
    imageStore(smoothedSpecular, pixel, vec4(specular / specular_weights, diffuse_weights / surface_weights));
}
