// Reprojection: finds the pixel of the last frame that saw the same surface.
#ifndef HISTORY_REPROJECT_GLSL
#define HISTORY_REPROJECT_GLSL
#include "gbuffer/motion.glsl"
#include "gbuffer/read.glsl"
#include "common/pattern.glsl"

uniform sampler2D lastDiffuse;
uniform sampler2D lastSpecular; // a: age [frames]
uniform sampler2D lastDistance;

// Whether pixel `at` of the last frame saw a surface at this distance, give or take `most` [m].
bool sawSurface(ivec2 at, float range, float most) {
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(camera.size)))) return false;
    return abs(texelFetch(lastDistance, at, 0).r - range) < most;
}

// Whether the surface was visible in the last frame, and the pixel `at` that saw it.
//
// The lookup takes one pixel without filtering, so that history stays sharp. The point is between pixels, and
// the frame's offset selects one of them. All pixels share the offset, so neighbours stay neighbours and keep
// their own directions. Offsets follow the R2 sequence (Roberts 2018), which limits the drift of history from
// its surface to about one pixel.
bool reproject(ivec2 pixel, GBufferSurface seen, out ivec2 at) {
    vec3 before = seen.position - motionAt(pixel);
    vec4 clip = camera.previous_view_projection * vec4(before, 1.0);
    if (clip.w <= 0.0) return false;
    vec2 offset = r2(camera.frame % 4096u, vec2(0.0)) - 0.5;
    vec2 place = (clip.xy / clip.w * 0.5 + 0.5) * vec2(camera.size) - 0.5 - pixelOffset();
    at = ivec2(floor(place + 0.5 + 0.98 * offset));
    // Distances must agree within 0.2%, plus the depth that an oblique surface spans in two pixels.
    float range = distance(before, camera.previous_position);
    float pixel_angle = 2.0 * tan(0.5 * camera.fov_y) / float(camera.size.y);
    float cosine = max(dot(seen.face, seen.to_viewer), 0.05);
    float most = range * (0.002 + 2.0 * pixel_angle / cosine);
    if (sawSurface(at, range, most)) return true;
    // At edges, pixels that sample their area see now one surface, now the other.
    if (PIXEL_IS_BOX) {
        ivec2 middle = at;
        for (int i = 0; i < 9; i++) {
            at = middle + ivec2(i % 3, i / 3) - 1;
            if (sawSurface(at, range, most)) return true;
        }
    }
    return false;
}

#endif
