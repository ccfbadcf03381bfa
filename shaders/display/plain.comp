#version 460
// Writes data unchanged: no exposure, tone map or encoding.

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D source;
uniform writeonly image2D display;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(pixel, imageSize(display))))
        imageStore(display, pixel, vec4(clamp(texelFetch(source, pixel, 0).rgb, 0.0, 1.0), 1.0));
}
