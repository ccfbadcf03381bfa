#version 460
#extension GL_GOOGLE_include_directive : require
// Cone probe for pixels that compute shaders shade.
#include "params.glsl"
#include "gbuffer/read.glsl"
#include "probe/record.glsl"

layout(local_size_x = 1) in;

void main() {
    ivec2 pixel = ivec2(params.probe);
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    GBufferSurface seen = gbufferAt(pixel);
    if (seen.any) recordCones(seen.surface, seen.position, seen.face, seen.to_viewer);
}
