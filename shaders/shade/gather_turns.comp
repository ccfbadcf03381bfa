#version 460
#extension GL_GOOGLE_include_directive : require
// Pixels gather in turns, each for several frames at once: a still picture has so many times the rays for the same price, and settles
// to the bit. What lies between its turns keeps what it gathered, looked up where it was seen last.
#include "params.glsl"
#include "common/random.glsl"
#include "shade/gather.glsl"

uniform sampler2D lastDiffuse;
uniform sampler2D lastSpecular;
uniform sampler2D lastDistance;

// Mirrors show what moves: smoother surfaces than this gather their reflections in every frame.
const float KEPT_ROUGHNESS = 0.1;

// The pixel of last frame's picture that saw a surface.
bool seenBefore(ivec2 pixel, GBufferSurface seen, out ivec2 at) {
    vec4 clip = camera.previous_view_projection * vec4(seen.position, 1.0);
    if (clip.w <= 0.0) return false;
    // To the nearest pixel, by chance as the point lies between them: what is kept neither blurs nor sticks to the picture.
    Random r = Random(uvec4(pixel, camera.frame, 0u));
    vec2 chance = next4(r).xy - 0.5;
    at = ivec2(floor((clip.xy / clip.w * 0.5 + 0.5) * vec2(camera.size) + 0.98 * chance));
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(camera.size)))) return false;
    // As far away as it was then, but for what a surface seen at a slant goes on in a pixel or two.
    float range = distance(seen.position, camera.previous_position), before = texelFetch(lastDistance, at, 0).r;
    float pixel_angle = 2.0 * tan(0.5 * camera.fov_y) / float(camera.size.y);
    return abs(before - range) < range * (0.002 + 2.0 * pixel_angle / max(dot(seen.face, seen.to_viewer), 0.05));
}

// Those whose turn it is come first: they take longest.
uint firstNumber() {
    uint turns = uint(params.gather_frames);
    return (camera.frame % turns * 64u + turns - 1u) / turns;
}

Gathered gatherOrKeep(ivec2 pixel, GBufferSurface seen, ConeOrigin o, out float age) {
    uint turns = uint(params.gather_frames);
    ivec2 at;
    bool due = pixelNumber(uvec2(pixel)) * turns / 64u == camera.frame % turns;
    if (!due && seenBefore(pixel, seen, at)) {
        vec4 specular = texelFetch(lastSpecular, at, 0);
        age = specular.a + 1.0;
        // A surface may move over the picture in step with the turns, and never be where it is one's turn.
        due = age > float(turns);
        if (!due) {
            Gathered kept = Gathered(texelFetch(lastDiffuse, at, 0), specular.rgb);
            if (params.specular_cone && seen.surface.roughness < KEPT_ROUGHNESS)
                kept.specular = gatherSpecular(o, seen.surface, seen.face, seen.to_viewer);
            return kept;
        }
    }
    age = 0.0;
    if (due) gatherTimes = params.gather_frames;
    return gather(o, seen.surface, seen.face, seen.to_viewer);
}
