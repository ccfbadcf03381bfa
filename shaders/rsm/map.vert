#version 460
#extension GL_GOOGLE_include_directive : require
// Surfaces that a light sees; pass.index is the view.
#include "params.glsl"
#include "common/scene.glsl"
#include "shadow/views.glsl"

layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec4 uv;
layout(location = 3) out vec4 color;
layout(location = 4) flat out uint material;

void main() {
    Draw draw = draws.draws[gl_InstanceIndex];
    VertexAttributes a = loadAttributes(gl_VertexIndex);
    position = toWorld(draw.instance, loadPosition(gl_VertexIndex));
    normal = normalToWorld(draw.instance, a.normal);
    uv = a.uv;
    color = a.color;
    material = draw.material;
    gl_Position = shadowViews.views[pass.index].view_projection * vec4(position, 1.0);
}
