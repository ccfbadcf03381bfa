#version 460
#extension GL_GOOGLE_include_directive : require
// Background: the sky's radiance.
#include "common/scene.glsl"

layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 radiance;

void main() {
    radiance = vec4(sceneInfo.sky, 1.0);
}
