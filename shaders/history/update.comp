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

// Smoother surfaces gather their reflection in every frame with motion, of the camera or in the scene.
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
    bool reprojected = reproject(pixel, seen, at);
    Age age = newAge(index);
    vec4 last = vec4(0.0);
    uint averaged = 0, most = mostAveraged();
    if (reprojected) {
        last = texelFetch(lastSpecular, at, 0);
        averaged = min(uint(last.a) / AGES, most);
        age = nextAge(seen, index, mod(last.a, float(AGES)));
        imageStore(gatheredDiffuse, pixel, texelFetch(lastDiffuse, at, 0));
    }
    if (age.due) {
        bool complete = most > 0 && averaged == most && cameraIsStill();
        // Few rays do not count as a round.
        if (reprojected && fract(last.a) == 0.0) averaged = min(averaged + 1, most);
        imageStore(gatheredSpecular, pixel, vec4(last.rgb, AGES * averaged + gatheredAge(index)));
        return complete ? GATHER_NOTHING : GATHER_ALL;
    }
    imageStore(gatheredSpecular, pixel, vec4(last.rgb, AGES * averaged + age.frames));
    if (!reprojected) return GATHER_FEW;
    bool moves = camera.still_frames == 0 || !cameraIsStill();
    bool mirrors = seen.surface.roughness < MIRROR_ROUGHNESS;
    return moves && mirrors ? GATHER_MIRRORED : GATHER_NOTHING;
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
