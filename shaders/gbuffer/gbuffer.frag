#version 460
#extension GL_GOOGLE_include_directive : require
// G-buffer for deferred shading. Costs 28 bytes per pixel, but no cones for uncovered pixels of a quad.
#include "params.glsl"
#include "gbuffer/fragment_surface.glsl"
#include "gbuffer/packing.glsl"

layout(location = 0) out vec4 gbufferBase;
layout(location = 1) out vec4 gbufferNormals;
layout(location = 2) out vec4 gbufferEmission;
layout(location = 3) out float gbufferDistance;
layout(location = 4) out vec4 gbufferMotion;

void main() {
    Material m = materials.materials[material];
    Gradient g = gradientHere();
    vec3 to_viewer = camera.position - position;
    vec3 face = faceNormal(normalize(to_viewer));
    vec2 rm = roughnessMetallic(m, interpolants(), g);
    gbufferBase = vec4(baseColor(m, interpolants(), g).rgb, rm.x);
    gbufferNormals = vec4(packNormal(shadingNormal(m, g, face)), packNormal(face));
    gbufferEmission = vec4(emission(m, interpolants(), g), packMetallic(rm.y, dielectricIndex(m)));
    gbufferDistance = length(to_viewer);
    gbufferMotion = vec4(motion, 0.0);
}
