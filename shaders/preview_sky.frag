#version 460
#extension GL_GOOGLE_include_directive : require
#include "params.glsl"
#include "scene.glsl"
#include "preview.glsl"

layout(location = 0) out vec4 display;

void main() {
    display = encoded(sceneInfo.sky);
}
