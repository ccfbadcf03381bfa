#version 460
#extension GL_GOOGLE_include_directive : require
// World-space attributes for the G-buffer and forward shading. gl_Position must equal depth.vert's to the
// bit.
#include "common/pixel.glsl"

layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec4 tangent;
layout(location = 3) out vec4 uv;
layout(location = 4) flat out uint material;
layout(location = 5) out vec4 color;
layout(location = 6) out vec3 motion; // since the last frame [m]

precise gl_Position; // same operations in both shaders: no contraction, so bit-equal depth

void main() {
    Draw draw = draws.draws[gl_InstanceIndex];
    vec3 local = loadPosition(gl_VertexIndex), p = toWorld(draw.instance, local);
    gl_Position = sampledClip(camera.view_projection * vec4(p, 1.0));
    VertexAttributes a = loadAttributes(gl_VertexIndex);
    position = p;
    normal = normalToWorld(draw.instance, a.normal);
    tangent = tangentToWorld(draw.instance, a.tangent);
    uv = a.uv;
    color = a.color;
    motion = displacement(draw.instance, local);
    material = draw.material;
}
