// Width of the filter over reflections. Gathering traces more rays where the filter averages few pixels.
#ifndef LOBE_FILTER_GLSL
#define LOBE_FILTER_GLSL
#include "common/ggx.glsl"
#include "common/scene.glsl"

// Angle between reflected directions at which the weight falls to a half, as a multiple of the lobe's alpha.
// Larger values blur reflections, smaller ones keep their noise.
const float LOBE_FRACTION = 0.35;

// Squared angle at which the weight falls to a half [rad^2].
float reflectionWidth2(Surface s) {
    float width = LOBE_FRACTION * ggxAlpha(s.roughness);
    return width * width;
}

// Squared angle between the rays of neighbouring pixels in the middle of the picture [rad^2].
float pixelAngle2() {
    vec2 size = 2.0 / (vec2(camera.projection[0][0], camera.projection[1][1]) * vec2(camera.size));
    return 0.5 * dot(size, size);
}

// Number of pixels that the filter averages on a flat surface, without the limit of 8x8: the integral of
// its weight.
float reflectionPixels(Surface s) {
    return PI / log(2.0) * reflectionWidth2(s) / pixelAngle2();
}

#endif
