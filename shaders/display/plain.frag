#version 460
// Data as it is: no exposure, tone map or encoding.

layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 display;

uniform sampler2D source;

void main() {
    display = vec4(clamp(texelFetch(source, ivec2(gl_FragCoord.xy), 0).rgb, 0.0, 1.0), 1.0);
}
