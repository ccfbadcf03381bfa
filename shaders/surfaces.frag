#version 460
#extension GL_GOOGLE_include_directive : require
// The surface that each pixel sees, for passes that shade it. Costs 28 bytes a pixel, and no cone is traced for the
// uncovered pixels of a triangle's quads.
#include "params.glsl"
#include "surface.glsl"
#include "seen.glsl"

layout(location = 0) out vec4 surfaceBase;
layout(location = 1) out vec4 surfaceNormals;
layout(location = 2) out vec4 surfaceEmission;
layout(location = 3) out float surfaceDistance;

void main() {
    Material m = materials.materials[material];
    Gradient g = Gradient(dFdx(uv), dFdy(uv));
    vec3 to_viewer = camera.position - position;
    vec3 face = faceNormal(normalize(to_viewer));
    vec2 rm = roughnessMetallic(m, uv, g);
    surfaceBase = vec4(baseColor(m, uv, g).rgb, rm.x);
    surfaceNormals = vec4(packNormal(shadingNormal(m, g, face)), packNormal(face));
    surfaceEmission = vec4(emission(m, uv, g), rm.y);
    surfaceDistance = length(to_viewer);
}
