#version 460
#extension GL_GOOGLE_include_directive : require
// Alpha mask for the depth-only passes.
#include "common/materials.glsl"

layout(location = 0) in vec2 uv;
layout(location = 1) flat in uint material;

void main() {
    Material m = materials.materials[material];
    if (baseColor(m, uv, Gradient(dFdx(uv), dFdy(uv))).a < m.alpha_cutoff) discard;
}
