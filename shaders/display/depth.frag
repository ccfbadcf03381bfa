#version 460
#extension GL_GOOGLE_include_directive : require
// Distance along the view direction, as a fraction of the diagonal of the scene's bounding box.
#include "common/scene.glsl"

layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 inspected;

uniform sampler2D seenDepth;

void main() {
    float along = camera.near / max(texelFetch(seenDepth, ivec2(gl_FragCoord.xy), 0).r, 1e-30);
    inspected = vec4(vec3(clamp(along / length(sceneInfo.bounds_max - sceneInfo.bounds_min), 0.0, 1.0)), 1.0);
}
