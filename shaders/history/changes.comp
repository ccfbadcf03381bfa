#version 460
#extension GL_GOOGLE_include_directive : require
// Measures how much gathered light has changed since pixels gathered it. While the camera stands still, a
// pixel repeats the directions of its last round, so that the difference is a change without noise (as with
// the samples that A-SVGF repeats, Schied et al. 2018). The filter then prefers pixels that saw the change.
#include "params.glsl"
#include "history/reproject.glsl"
#include "history/rounds.glsl"

// A group measures 6x6 tiles of 8x8 pixels, each from the 3x3 tiles around it.
const int OUTPUT_TILES = 6;
const int TILES = OUTPUT_TILES + 2;
const int TILE_THREADS = 4;

layout(local_size_x = TILES * TILES * TILE_THREADS) in;

uniform sampler2D gatheredDiffuse;
uniform sampler2D gatheredSpecular;
uniform writeonly image2D gatherChange;

const float FILTERED = 64.0; // pixels

// Variances of the mean change that are taken for noise. Under a moving camera pixels inherit from others,
// which have other directions.
const float STILL_DOUBT = 1.0;
const float MOVING_DOUBT = 16.0;

struct Sums {
    float count;
    float change, change2;
    float light, light2;
};

Sums plus(Sums a, Sums b) {
    return Sums(a.count + b.count, a.change + b.change, a.change2 + b.change2, a.light + b.light,
        a.light2 + b.light2);
}

shared Sums shared_sums[TILES * TILES * TILE_THREADS];

void add(inout Sums sums, ivec2 pixel) {
    if (any(greaterThanEqual(uvec2(pixel), uvec2(camera.size)))) return;
    vec4 specular = texelFetch(gatheredSpecular, pixel, 0);
    float age = mod(specular.a, float(AGES));
    if (age > 0.25 * float(params.phases)) return; // see gatheredAge
    GBufferSurface seen = gbufferAt(pixel);
    ivec2 at;
    if (!seen.any || !reproject(pixel, seen, at)) return;
    vec4 last = texelFetch(lastSpecular, at, 0);
    // Few rays are too noisy.
    if (fract(last.a) != 0.0 || mod(last.a, float(AGES)) <= age) return;
    float light = luminance(texelFetch(gatheredDiffuse, pixel, 0).rgb + specular.rgb);
    float change = light - luminance(texelFetch(lastDiffuse, at, 0).rgb + last.rgb);
    sums = plus(sums, Sums(1.0, change, change * change, light, light * light));
}

// Squared mean change, without its noise, over the variance of filtered light, where it exceeds that: about
// the number of pixels that have not seen the change for which one that has makes up.
float significance(Sums sums) {
    if (sums.count < 2.0) return 0.0;
    float mean = sums.change / sums.count, light = sums.light / sums.count, others = sums.count - 1.0;
    float noise = max(sums.change2 / sums.count - mean * mean, 0.0) / others;
    float variance = max((sums.light2 - sums.count * light * light) / others, 1e-4 * light * light);
    float doubt = cameraIsStill() ? STILL_DOUBT : MOVING_DOUBT;
    return max(FILTERED * (mean * mean - doubt * noise) / max(variance, 1e-20) - 1.0, 0.0);
}

void main() {
    int thread = int(gl_LocalInvocationIndex), mine = thread / TILE_THREADS;
    ivec2 corner = OUTPUT_TILES * ivec2(gl_WorkGroupID.xy) - 1;
    Sums sums = Sums(0.0, 0.0, 0.0, 0.0, 0.0);
    if (camera.still_frames < bounceMeanStart()) {
        ivec2 origin = 8 * (corner + ivec2(mine % TILES, mine / TILES));
        for (int i = thread % TILE_THREADS; i < 64; i += TILE_THREADS)
            add(sums, origin + ivec2(i & 7, i >> 3));
    }
    shared_sums[thread] = sums;
    barrier();
    ivec2 tile = ivec2(thread % OUTPUT_TILES, thread / OUTPUT_TILES);
    ivec2 at = corner + 1 + tile;
    if (tile.y >= OUTPUT_TILES || any(greaterThanEqual(8 * at, ivec2(camera.size)))) return;
    Sums all = Sums(0.0, 0.0, 0.0, 0.0, 0.0);
    for (int i = 0; i < 9 * TILE_THREADS; i++) {
        ivec2 near = tile + ivec2(i / TILE_THREADS % 3, i / TILE_THREADS / 3);
        all = plus(all, shared_sums[(near.y * TILES + near.x) * TILE_THREADS + i % TILE_THREADS]);
    }
    float still = float(min(camera.still_frames, uint(params.phases)));
    float changing = float(min(camera.changing_frames, uint(params.phases)));
    imageStore(gatherChange, at, vec4(min(significance(all), 6e4), still, changing, 0.0));
}
