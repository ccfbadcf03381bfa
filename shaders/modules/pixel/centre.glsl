// Pixels sample their centre.
#ifndef PIXEL_MODULE_GLSL
#define PIXEL_MODULE_GLSL

const bool PIXEL_IS_BOX = false;

// Edge of the square of texels that a sample averages, in pixels.
const float PIXEL_FOOTPRINT = 1.0;

// Place of the sample, from the pixel's centre [pixels].
vec2 pixelOffset() {
    return vec2(0.0);
}

#endif
