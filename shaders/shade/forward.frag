#version 460
#extension GL_GOOGLE_include_directive : require
// Final shading in the fragment shader, one output per light component (thesis, Section 4.5).
#include "params.glsl"
#include "gbuffer/fragment_surface.glsl"
#include "shade/shade.glsl"

layout(location = 0) out vec4 radiance; // total, including emission
layout(location = 1) out vec4 direct;
layout(location = 2) out vec4 diffuseIndirect;
layout(location = 3) out vec4 specularIndirect;
layout(location = 4) out vec4 occlusion; // 1: open
layout(location = 5) out vec4 surfaceNormal; // * 0.5 + 0.5

vec2 pixelCentre() {
    return gl_FragCoord.xy;
}

void main() {
    Material m = materials.materials[material];
    Gradient g = gradientHere();
    vec3 v = normalize(camera.position - position);
    vec3 face = faceNormal(v);
    // No derivatives below. Helper invocations at triangle edges cover nothing and need no cones.
    if (gl_SampleMaskIn[0] == 0) return;
    Surface s = surfaceAt(m, g, face, v);
    Shading light = shade(s, position, face, v);

    radiance = vec4(light.direct + light.diffuse + light.specular + emission(m, interpolants(), g), 1.0);
    direct = vec4(light.direct, 1.0);
    diffuseIndirect = vec4(light.diffuse, 1.0);
    specularIndirect = vec4(light.specular, 1.0);
    occlusion = vec4(vec3(light.open), 1.0);
    surfaceNormal = vec4(s.normal * 0.5 + 0.5, 1.0);
}
