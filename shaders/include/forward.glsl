// Final shading (thesis, Algorithm 3), each contribution to its own output. Indirect diffuse light is
// albedo * sum_c w_c L_c with L_c the mean radiance of a cone, sky included where it escapes.
#ifndef FORWARD_GLSL
#define FORWARD_GLSL
#include "params.glsl"
#include "gather.glsl"
#include "shadow.glsl"
#include "direct.glsl"

layout(location = 0) out vec4 radiance; // everything, emission included
layout(location = 1) out vec4 direct;
layout(location = 2) out vec4 diffuseIndirect;
layout(location = 3) out vec4 specularIndirect;
layout(location = 4) out vec4 occlusion; // 1: open
layout(location = 5) out vec4 surfaceNormal; // * .5 + .5

float lightVisibility(Light light, vec3 p, vec3 face, vec3 to_light) {
    return shadowVisibility(light, p, face, to_light);
}

void main() {
    Material m = materials.materials[material];
    Gradient g = Gradient(dFdx(uv), dFdy(uv));
    vec3 v = normalize(camera.position - position);
    vec3 face = faceNormal(v);
    // Derivatives end here. Helper invocations at the edges of triangles cover nothing and need no cones.
    if (gl_SampleMaskIn[0] == 0) return;
    Surface s = surfaceAt(m, g, face);

    vec3 light = directLight(s, position, face, v);
    ConeOrigin o = coneOrigin(position, face, s.normal);
    vec4 hemisphere = diffuseCone(o, s, face);
    vec3 diffuse = s.albedo * hemisphere.rgb * params.indirect_scale;
    vec3 specular = params.specular_cone ? specularCone(o, s, face, v) * params.indirect_scale : vec3(0.0);
    if (params.multiply_occlusion == MULTIPLY_OCCLUSION_ALL) light *= hemisphere.a;

    radiance = vec4(light + diffuse + specular + emission(m, uv, g), 1.0);
    direct = vec4(light, 1.0);
    diffuseIndirect = vec4(diffuse, 1.0);
    specularIndirect = vec4(specular, 1.0);
    occlusion = vec4(vec3(hemisphere.a), 1.0);
    surfaceNormal = vec4(s.normal * 0.5 + 0.5, 1.0);
}

#endif
