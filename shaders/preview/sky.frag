#version 460
#extension GL_GOOGLE_include_directive : require
#include "params.glsl"
#include "common/scene.glsl"
#include "preview/preview.glsl"

layout(location = 0) out vec4 display;

void main() {
    display = encoded(sceneInfo.sky);
}
