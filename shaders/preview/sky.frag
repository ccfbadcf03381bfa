#version 460
#extension GL_GOOGLE_include_directive : require
#include "params.glsl"
#include "lights/sky.glsl"
#include "common/view_ray.glsl"
#include "preview/preview.glsl"

layout(location = 0) out vec4 display;

void main() {
    display = encoded(skyBehind(viewRay(gl_FragCoord.xy)));
}
