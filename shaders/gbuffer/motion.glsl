#ifndef GBUFFER_MOTION_GLSL
#define GBUFFER_MOTION_GLSL

uniform sampler2D gbufferMotion;

// Displacement of the surface in a pixel since the last frame [m].
vec3 motionAt(ivec2 pixel) {
    return params.moves == 1 ? texelFetch(gbufferMotion, pixel, 0).xyz : vec3(0.0);
}

#endif
