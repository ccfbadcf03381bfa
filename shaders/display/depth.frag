#version 460
#extension GL_GOOGLE_include_directive : require
// Distance along the view direction, as a share of the scene's size.
#include "common/scene.glsl"

layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 inspected;

uniform sampler2D depth;

void main() {
    float z = texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r;
    vec4 h = camera.inverse_view_projection * vec4(uv * 2.0 - 1.0, z, 1.0);
    float along = dot(h.xyz / h.w - camera.position, camera.direction);
    inspected = vec4(vec3(clamp(along / length(sceneInfo.bounds_max - sceneInfo.bounds_min), 0.0, 1.0)), 1.0);
}
