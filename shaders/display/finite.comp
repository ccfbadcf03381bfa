#version 460
// Counts texels of the picture's light that are no finite numbers: the 8-bit picture would hide them.

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D source;

layout(std430) buffer PictureErrors { uint not_finite; } pictureErrors;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, textureSize(source, 0)))) return;
    vec3 light = texelFetch(source, pixel, 0).rgb;
    if (any(isnan(light)) || any(isinf(light))) atomicAdd(pictureErrors.not_finite, 1u);
}
