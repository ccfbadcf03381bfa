// Display transform of the preview: exposure, Reinhard tone map and a gamma of 2.2.
#ifndef PREVIEW_GLSL
#define PREVIEW_GLSL

vec4 encoded(vec3 radiance) {
    vec3 c = radiance * exp2(params.exposure);
    return vec4(pow(c / (c + 1.0), vec3(1.0 / 2.2)), 1.0);
}

#endif
