#version 460
#extension GL_GOOGLE_include_directive : require
// Depth prepass (thesis, Section 4.7.1). Positions must equal those of gbuffer/surface.vert to the bit: the
// shading pass compares depth with EQUAL.
#include "common/pixel.glsl"

layout(location = 0) out vec4 uv;
layout(location = 1) flat out uint material;
layout(location = 2) out float alpha; // of the vertex colour

precise gl_Position; // same operations in both shaders: no contraction, so bit-equal depth

void main() {
    Draw draw = draws.draws[gl_InstanceIndex];
    vec3 p = toWorld(draw.instance, loadPosition(gl_VertexIndex));
    gl_Position = sampledClip(camera.view_projection * vec4(p, 1.0));
    VertexAttributes a = loadAttributes(gl_VertexIndex);
    uv = a.uv;
    alpha = a.color.a;
    material = draw.material;
}
