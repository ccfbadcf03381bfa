#version 460
#extension GL_GOOGLE_include_directive : require
// Shades the cubes by face orientation, so that their faces can be distinguished.
#include "common/scene.glsl"

layout(location = 0) flat in vec4 color;
layout(location = 1) in vec3 position;
layout(location = 0) out vec4 voxelView;

void main() {
    vec3 n = normalize(cross(dFdx(position), dFdy(position)));
    vec3 a = abs(n);
    float light = dot(a * a, vec3(0.8, 1.0, 0.65));
    voxelView = vec4(color.rgb * light, 1.0);
}
