// Final shading (thesis, Algorithm 3). Indirect diffuse light is albedo * sum_c w_c L_c. L_c is the mean
// radiance of a cone, including the sky if it escapes.
#ifndef SHADE_GLSL
#define SHADE_GLSL
#include "modules/trace.glsl"
#include "shadow/visibility.glsl"
#include "lights/direct.glsl"

// Radiance towards the viewer by component, without emission.
struct Shading {
    vec3 direct;
    vec3 diffuse; // indirect
    vec3 specular; // indirect
    float open; // openness: unoccluded fraction of the hemisphere, cosine-weighted
};

// face: geometric normal; v: to the viewer; both on the same side.
Shading shade(Surface s, vec3 p, vec3 face, vec3 v) {
    vec3 direct = directLight(s, p, face, v);
    Gathered light = gather(coneOrigin(p, face, s.normal), s, face, v);
    return Shading(direct, s.albedo * light.hemisphere.rgb, light.specular, light.hemisphere.a);
}

#endif
