#version 460
#extension GL_GOOGLE_include_directive : require
// The cone probe: shading's own cones at the pixel under the pointer, with every sample written down.
#define SAMPLES_ACCESS
#define CONE_RECORD
#include "params.glsl"
#include "cone_samples.glsl"

// Stores would otherwise move the depth test behind the shader.
layout(early_fragment_tests) in;

uint cone = 0;
uint rows = 0;

void recordCone(uint number) {
    cone = number;
}

void recordSample(int number, vec3 p, float along, float advance, float radius, float level, float cell, vec4 texel, float taken, float transmittance) {
    if (rows >= coneSamples.list.length()) return;
    vec3 radiance = taken > 0.0 ? texel.rgb * (taken / texel.a) : vec3(0.0);
    coneSamples.list[rows] = ConeSample(cone, uint(number), along, advance, p, level, radiance, cell, texel.a, taken, transmittance, radius);
    rows++;
}

#include "gather.glsl"

void main() {
    Material m = materials.materials[material];
    Gradient g = Gradient(dFdx(uv), dFdy(uv));
    vec3 v = normalize(camera.position - position);
    vec3 face = faceNormal(v);
    if (gl_SampleMaskIn[0] == 0 || ivec2(gl_FragCoord.xy) != ivec2(params.probe)) return;
    // Where triangles meet in one depth, the first one is recorded.
    if (atomicCompSwap(coneSamples.claimed, 0u, 1u) != 0u) return;
    Surface s = surfaceAt(m, g, face);
    ConeOrigin o = coneOrigin(position, face, s.normal);
    diffuseCone(o, s, face);
    if (params.specular_cone) specularCone(o, s, face, v);
    coneSamples.surface = position;
    coneSamples.origin = o.position;
    coneSamples.draw = uvec4(SAMPLE_VERTICES, rows, 0, 0);
}
