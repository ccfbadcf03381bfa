#version 460
#extension GL_GOOGLE_include_directive : require
// Background: the sky's radiance.
#include "lights/sky.glsl"
#include "common/view_ray.glsl"

layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 radiance;

void main() {
    radiance = vec4(skyBehind(viewRay(gl_FragCoord.xy)), 1.0);
}
