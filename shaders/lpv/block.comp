#version 460
#extension GL_GOOGLE_include_directive : require
// Adds the surfaces that the camera sees to the blockers, by every other pixel.
#include "params.glsl"
#include "gbuffer/read.glsl"
#include "lpv/blockers.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
    ivec2 pixel = 2 * ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    GBufferSurface seen = gbufferAt(pixel);
    if (!seen.any) return;
    vec3 off = seen.position - camera.position;
    vec2 at_unit = 4.0 / (vec2(camera.size) * vec2(camera.projection[0][0], camera.projection[1][1]));
    float forward = dot(off, camera.direction), cosine = max(dot(seen.face, seen.to_viewer), 0.1);
    float area = abs(at_unit.x * at_unit.y) * forward * forward * (forward / length(off)) / cosine;
    addBlocker(seen.position, seen.face, area, 1);
}
