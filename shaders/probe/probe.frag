#version 460
#extension GL_GOOGLE_include_directive : require
// The cone probe: shading's own cones at the pixel under the pointer, with every sample written down.
#include "params.glsl"
#include "gbuffer/fragment_surface.glsl"
#include "probe/record.glsl"

// Stores would otherwise move the depth test behind the shader.
layout(early_fragment_tests) in;

void main() {
    Material m = materials.materials[material];
    Gradient g = gradientHere();
    vec3 v = normalize(camera.position - position);
    vec3 face = faceNormal(v);
    if (gl_SampleMaskIn[0] == 0 || ivec2(gl_FragCoord.xy) != ivec2(params.probe)) return;
    // Where triangles meet in one depth, the first one is recorded.
    if (atomicCompSwap(coneSamples.claimed, 0u, 1u) != 0u) return;
    recordCones(surfaceAt(m, g, face, v), position, face, v);
}
