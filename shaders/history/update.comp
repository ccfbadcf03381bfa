#version 460
#extension GL_GOOGLE_include_directive : require
// Reprojects gathered light from the last frame where the same surface was visible, and queues the pixels
// that gather again.
#include "params.glsl"
#include "history/reproject.glsl"
#include "history/age.glsl"
#include "history/enqueue.glsl"

uniform writeonly image2D gatheredDiffuse;
uniform writeonly image2D gatheredSpecular;

// Smoother surfaces gather their reflection in every frame: mirrors show motion.
const float MIRROR_ROUGHNESS = 0.1;

// Stores the history of a pixel and its age. Returns how the pixel gathers. index: in the 8x8 tile.
uint updateHistory(ivec2 pixel, uint index) {
    GBufferSurface seen = gbufferAt(pixel);
    if (!seen.any) {
        imageStore(gatheredDiffuse, pixel, vec4(0.0, 0.0, 0.0, 1.0));
        imageStore(gatheredSpecular, pixel, vec4(0.0));
        return GATHER_NOTHING;
    }
    ivec2 at;
    bool reprojected = reproject(seen, at);
    Age age = newAge(index);
    vec4 last = vec4(0.0);
    if (reprojected) {
        last = texelFetch(lastSpecular, at, 0);
        age = nextAge(seen, index, last.a);
    }
    if (age.due) {
        imageStore(gatheredSpecular, pixel, vec4(0.0, 0.0, 0.0, gatheredAge(index)));
        return GATHER_ALL;
    }
    imageStore(gatheredSpecular, pixel, vec4(last.rgb, age.frames));
    if (!reprojected) return GATHER_FEW;
    imageStore(gatheredDiffuse, pixel, texelFetch(lastDiffuse, at, 0));
    bool mirrors = seen.surface.roughness < MIRROR_ROUGHNESS;
    return mirrors ? GATHER_MIRRORED : GATHER_NOTHING;
}

void main() {
    beginRegion();
    for (uint i = gl_LocalInvocationIndex; i < REGION_PIXELS; i += REGION_THREADS) {
        ivec2 pixel = regionPixel(i);
        uint index = patternIndex(uvec2(pixel)), mode = GATHER_NOTHING;
        if (all(lessThan(pixel, ivec2(camera.size)))) mode = updateHistory(pixel, index);
        enqueue(i, mode, index);
    }
    endRegion();
}
