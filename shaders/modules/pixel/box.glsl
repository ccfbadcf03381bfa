// Pixels sample another place of their square in each frame; the mean over frames is that of a box filter.
#ifndef PIXEL_MODULE_GLSL
#define PIXEL_MODULE_GLSL
#include "common/pattern.glsl"
#include "common/scene.glsl"

const bool PIXEL_IS_BOX = true;

// Edge of the square of texels that a sample averages, in pixels. Under a moving camera about 19 frames are
// averaged, four by four samples.
const float PIXEL_FOOTPRINT = 0.25;

// Place of the sample, from the pixel's centre [pixels].
vec2 pixelOffset() {
    return r2(camera.frame % 4096u, vec2(0.0)) - 0.5;
}

#endif
