#version 460
#extension GL_GOOGLE_include_directive : require
// Depth from a light (thesis, Section 4.2); pass.index is the layer.
#include "params.glsl"
#include "common/scene.glsl"
#include "shadow/layers.glsl"

layout(location = 0) out vec4 uv;
layout(location = 1) flat out uint material;
layout(location = 2) out float alpha; // of the vertex colour

void main() {
    Draw draw = draws.draws[gl_InstanceIndex];
    vec3 p = toWorld(draw.instance, loadPosition(gl_VertexIndex));
    ShadowLayer layer = shadowLayers.layers[pass.index];
    gl_Position = layer.view_projection * vec4(p, 1.0);
    // A lamp's square is at the first corner of its page. Texels beyond it are drawn, too, but not read.
    if (layer.edge < params.shadow_dim) {
        float share = float(layer.edge) / float(params.shadow_dim);
        gl_Position.xy = (gl_Position.xy + gl_Position.w) * share - gl_Position.w;
    }
    VertexAttributes a = loadAttributes(gl_VertexIndex);
    uv = a.uv;
    alpha = a.color.a;
    material = draw.material;
}
