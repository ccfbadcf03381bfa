// Unit of the radiance texture of thesis.ron.
#ifndef INJECTION_EXPOSURE_GLSL
#define INJECTION_EXPOSURE_GLSL
#include "params.glsl"
#include "common/scene.glsl"
#include "common/math.glsl"
#include "lights/lights.glsl"

// Radiance of a texel value of 1. A sun of irradiance E reflects E / pi from a white surface that faces it,
// which was 1 in the published program.
float injectionExposure() {
    if (params.injection_exposure > 0.0) return params.injection_exposure;
    float brightest = 0.0;
    for (uint i = 0; i < sceneInfo.light_count; i++)
        if (lights.lights[i].kind == LIGHT_DIRECTIONAL)
            brightest = max(brightest, luminance(lights.lights[i].color));
    return brightest > 0.0 ? brightest / PI : 1.0;
}

#endif
