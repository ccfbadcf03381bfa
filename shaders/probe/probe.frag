#version 460
#extension GL_GOOGLE_include_directive : require
// Cone probe: traces the cones of shading at the pixel under the pointer, and records every sample.
#include "params.glsl"
#include "gbuffer/fragment_surface.glsl"
#include "probe/record.glsl"

// Without this, stores would move the depth test after the shader.
layout(early_fragment_tests) in;

void main() {
    Material m = materials.materials[material];
    Gradient g = gradientHere();
    vec3 v = normalize(camera.position - position);
    vec3 face = faceNormal(v);
    if (gl_SampleMaskIn[0] == 0 || ivec2(gl_FragCoord.xy) != ivec2(params.probe)) return;
    // If triangles have the same depth, only the first one is recorded.
    if (atomicCompSwap(coneSamples.claimed, 0u, 1u) != 0u) return;
    recordCones(surfaceAt(m, g, face, v), position, face, v);
}
