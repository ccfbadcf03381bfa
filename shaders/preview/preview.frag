#version 460
#extension GL_GOOGLE_include_directive : require
// Base colour lit by a lamp at the camera, plus emission.
#include "params.glsl"
#include "common/scene.glsl"
#include "materials/materials.glsl"
#include "preview/preview.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 uv;
layout(location = 3) flat in uint material;
layout(location = 4) in vec4 color;
layout(location = 0) out vec4 display;

void main() {
    Material m = materials.materials[material];
    Gradient g = Gradient(dFdx(uv), dFdy(uv));
    Interpolants at = Interpolants(uv, color);
    vec4 base = baseColor(m, at, g);
    if (base.a < m.alpha_cutoff) discard;
    float facing = abs(dot(normalize(normal), normalize(camera.position - position))); // two-sided
    display = encoded(base.rgb * (0.2 + 0.8 * facing) + emission(m, at, g));
}
