#version 460
#extension GL_GOOGLE_include_directive : require
// Gathers for every rsm_spacing-th pixel. Alpha is 1 where it sees a surface.
#include "params.glsl"
#include "gbuffer/read.glsl"
#include "rsm/gather.glsl"
#include "rsm/spacing.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform writeonly image2D rsmSparse;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, sparseSize()))) return;
    GBufferSurface seen = gbufferAt(pixelOf(at));
    vec4 light = vec4(0.0);
    if (seen.any) light = vec4(rsmLight(seen.position, seen.surface.normal), 1.0);
    imageStore(rsmSparse, at, light);
}
