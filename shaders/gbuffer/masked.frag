#version 460
#extension GL_GOOGLE_include_directive : require
// Alpha mask for the depth-only passes.
#include "materials/materials.glsl"

layout(location = 0) in vec4 uv;
layout(location = 1) flat in uint material;
layout(location = 2) in float alpha;

void main() {
    Material m = materials.materials[material];
    if (baseColor(m, Interpolants(uv, vec4(alpha)), Gradient(dFdx(uv), dFdy(uv))).a < m.alpha_cutoff) discard;
}
