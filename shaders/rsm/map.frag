#version 460
#extension GL_GOOGLE_include_directive : require
// Flux that a texel reflects, as if surfaces were diffuse: the diffuse albedo and that of the specular
// lobe.
#include "params.glsl"
#include "common/scene.glsl"
#include "common/math.glsl"
#include "lights/lights.glsl"
#include "materials/materials.glsl"
#include "modules/reflectance.glsl"
#include "shadow/views.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 uv;
layout(location = 3) in vec4 color;
layout(location = 4) flat in uint material;
layout(location = 0) out vec4 flux;
layout(location = 1) out vec2 packed;

void main() {
    Material m = materials.materials[material];
    Gradient g = Gradient(dFdx(uv), dFdy(uv));
    Interpolants here = Interpolants(uv, color);
    vec4 base = baseColor(m, here, g);
    if (base.a < m.alpha_cutoff) discard;
    Light light = lights.lights[shadowViews.views[pass.index].light];
    Incident incident = incidentLight(light, position);
    vec3 n = normalize(normal);
    if (dot(n, incident.to_light) < 0.0) n = -n;
    // Flux is irradiance across the rays times the area of a texel there. Of a lamp, that area is the
    // texel's at unit distance along the axis times d^2 cos^3.
    float area = 1.0;
    if (light.kind != LIGHT_DIRECTIONAL) {
        vec3 off = position - light.position;
        mat4 m = transpose(shadowViews.views[pass.index].view_projection);
        float cosine = dot(normalize(m[3].xyz), off) * inversesqrt(max(dot(off, off), 1e-12));
        area = max(dot(off, off), 1e-6) * cosine * cosine * cosine;
    }
    flux = vec4(min(reflectanceOf(m, base.rgb, here, g) * incident.irradiance * area, 60000.0), 1.0);
    packed = octahedral(n);
}
