#version 460
#extension GL_GOOGLE_include_directive : require
// World-space vertices for the raster and tessellation voxelizers.
#include "common/scene.glsl"

layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec4 uv;
layout(location = 3) flat out uint material;
layout(location = 4) flat out uint drawn;
layout(location = 5) out vec4 color;

void main() {
    Draw draw = draws.draws[gl_InstanceIndex];
    VertexAttributes a = loadAttributes(gl_VertexIndex);
    position = toWorld(draw.instance, loadPosition(gl_VertexIndex));
    normal = normalize(normalToWorld(draw.instance, a.normal));
    uv = a.uv;
    color = a.color;
    material = draw.material;
    drawn = gl_InstanceIndex;
}
