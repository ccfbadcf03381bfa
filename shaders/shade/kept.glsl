// What pixels keep between their turns, and which have nothing to keep.
#include "common/gbuffer_read.glsl"
#include "shade/list.glsl"

uniform sampler2D lastDiffuse;
uniform sampler2D lastSpecular;
uniform sampler2D lastDistance;

// How a listed pixel gathers.
const uint GATHER_FEW = 0; // nothing is known of it: FEW_RAYS, until its turn comes
const uint GATHER_ALL = 1; // as in its turn, which it has missed
const uint GATHER_MIRRORED = 2; // its reflection alone, not in its turn
const int FEW_RAYS = 4;

// The pixel of last frame's picture that saw a surface.
bool seenBefore(GBufferSurface seen, out ivec2 at) {
    vec4 clip = camera.previous_view_projection * vec4(seen.position, 1.0);
    if (clip.w <= 0.0) return false;
    // To the nearest pixel, as the point lies between them and the frame's share decides: what is kept neither blurs nor sticks to the
    // picture, and neighbours stay neighbours, each with its own part of all directions. Shares are spread evenly over frames (R2
    // sequence, Roberts 2018), so that what is kept never strays by more than a pixel or so.
    vec2 chance = fract(float(camera.frame % 4096u) * vec2(0.7548776662, 0.5698402910)) - 0.5;
    vec2 middle = (clip.xy / clip.w * 0.5 + 0.5) * vec2(camera.size) - 0.5;
    at = ivec2(floor(middle + 0.5 + 0.98 * chance));
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(camera.size)))) return false;
    // As far away as it was then, but for what a surface seen at a slant goes on in a pixel or two.
    float range = distance(seen.position, camera.previous_position), before = texelFetch(lastDistance, at, 0).r;
    float pixel_angle = 2.0 * tan(0.5 * camera.fov_y) / float(camera.size.y);
    return abs(before - range) < range * (0.002 + 2.0 * pixel_angle / max(dot(seen.face, seen.to_viewer), 0.05));
}

// Of what was kept there: frames since it was gathered.
float ageAt(ivec2 at) {
    return texelFetch(lastSpecular, at, 0).a;
}
