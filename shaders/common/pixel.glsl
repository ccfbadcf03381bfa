// Place of a pixel's sample in this frame.
#ifndef PIXEL_GLSL
#define PIXEL_GLSL
#include "common/view_ray.glsl"
#include "modules/pixel.glsl"

vec3 pixelRay(ivec2 pixel) {
    return viewRay(vec2(pixel) + 0.5 + pixelOffset());
}

// Moves the picture so that samples are at the centres of pixels, where rasterisers take them.
vec4 sampledClip(vec4 clip) {
    return vec4(clip.xy - 2.0 * clip.w / vec2(camera.size) * pixelOffset(), clip.zw);
}

#endif
