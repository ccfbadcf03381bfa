#version 460
// Draws antialiased lines. Parts behind visible surfaces are faint.

layout(location = 0) flat in vec4 color;
layout(location = 1) in float across;
layout(location = 2) flat in float half_width;
layout(location = 0) out vec4 display;

uniform sampler2D seenDepth;

void main() {
    float cover = clamp(half_width + 0.5 - abs(across), 0.0, 1.0);
    bool behind = gl_FragCoord.z < texelFetch(seenDepth, ivec2(gl_FragCoord.xy), 0).r;
    display = vec4(color.rgb, color.a * cover * (behind ? 0.25 : 1.0));
}
