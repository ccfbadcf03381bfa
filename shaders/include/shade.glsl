// Final shading (thesis, Algorithm 3). Indirect diffuse light is albedo * sum_c w_c L_c with L_c the mean radiance of a
// cone, sky included where it escapes.
#ifndef SHADE_GLSL
#define SHADE_GLSL
#include "gather.glsl"
#include "shadow.glsl"
#include "direct.glsl"

// Radiance towards the viewer by contribution, without emission.
struct Shading {
    vec3 direct;
    vec3 diffuse; // indirect
    vec3 specular; // indirect
    float open; // share of the hemisphere that is, cosine-weighted
};

float lightVisibility(Light light, vec3 p, vec3 face, vec3 to_light) {
    return shadowVisibility(light, p, face, to_light);
}

// face: the geometric normal, v: to the viewer; both on one side.
Shading shade(Surface s, vec3 p, vec3 face, vec3 v) {
    Shading result;
    result.direct = directLight(s, p, face, v);
    ConeOrigin o = coneOrigin(p, face, s.normal);
    Gathered light = gather(o, s, face, v);
    result.diffuse = s.albedo * light.hemisphere.rgb * params.indirect_scale;
    result.specular = light.specular * params.indirect_scale;
    result.open = light.hemisphere.a;
    if (params.multiply_occlusion == MULTIPLY_OCCLUSION_ALL) result.direct *= light.hemisphere.a;
    return result;
}

#endif
