#version 460
#extension GL_GOOGLE_include_directive : require
// Applies exposure, tone map and encoding: linear radiance to the 8-bit image.
#include "params.glsl"
#include "modules/tone_map.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D source;
uniform writeonly image2D display;

// Counts pixels with NaN or infinity, which the 8-bit image would hide.
layout(std430) buffer PictureErrors { uint not_finite; } pictureErrors;

vec3 encode(vec3 c) {
    if (params.gamma22 != 0) return pow(c, vec3(1.0 / 2.2)); // thesis, Algorithm 3
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(display)))) return;
    vec3 light = texelFetch(source, pixel, 0).rgb;
    if (any(isnan(light)) || any(isinf(light))) atomicAdd(pictureErrors.not_finite, 1u);
    vec3 c = max(light, 0.0);
    imageStore(display, pixel, vec4(encode(toneMap(c * exp2(params.exposure))), 1.0));
}
