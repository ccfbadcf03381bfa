// The pixels that gather first.
#ifndef RSM_SPACING_GLSL
#define RSM_SPACING_GLSL

ivec2 sparseSize() {
    return (ivec2(camera.size) + params.rsm_spacing - 1) / params.rsm_spacing;
}

ivec2 pixelOf(ivec2 sparse) {
    return min(sparse * params.rsm_spacing + params.rsm_spacing / 2, ivec2(camera.size) - 1);
}

#endif
