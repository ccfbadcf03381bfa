#version 460
#extension GL_GOOGLE_include_directive : require
// Final shading (thesis, Algorithm 3), each contribution to its own output. Indirect diffuse light is
// albedo * sum_c w_c L_c with L_c the mean radiance of a cone, sky included where it escapes.
#include "params.glsl"
#include "scene.glsl"
#include "materials.glsl"
#include "brdf.glsl"
#include "shadow.glsl"
#include "cone.glsl"
#include "cone_sets.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec2 uv;
layout(location = 4) flat in uint material;

layout(location = 0) out vec4 radiance; // everything, emission included
layout(location = 1) out vec4 direct;
layout(location = 2) out vec4 diffuseIndirect;
layout(location = 3) out vec4 specularIndirect;
layout(location = 4) out vec4 occlusion; // 1: open
layout(location = 5) out vec4 surfaceNormal; // * .5 + .5

vec3 shadingNormal(Material m, Gradient g, vec3 face) {
    vec3 n = normalize(normal);
    float side = dot(n, face) < 0.0 ? -1.0 : 1.0; // back faces of two-sided surfaces
    if (m.normal_texture != NO_TEXTURE) {
        vec3 t = tangentNormal(m, uv, g);
        vec3 x = tangent.xyz - n * dot(n, tangent.xyz);
        if (dot(x, x) > 1e-12) {
            x = normalize(x);
            n = normalize(mat3(x, cross(n, x) * tangent.w, n) * t);
        }
    }
    return n * side;
}

vec3 directLight(Surface s, vec3 face, vec3 v) {
    vec3 sum = vec3(0.0);
    for (uint i = 0; i < sceneInfo.light_count; i++) {
        Light light = lights.lights[i];
        Incident incident = incidentLight(light, position);
        float cosine = dot(s.normal, incident.to_light);
        if (cosine <= 0.0 || dot(face, incident.to_light) <= 0.0) continue;
        vec3 brdf = diffuseBrdf(s) + specularBrdf(s, v, incident.to_light);
        sum += brdf * incident.irradiance * cosine * shadowVisibility(light, position, face, incident.to_light);
    }
    return sum;
}

// What a cone contributes: its radiance, the sky where it escaped, and the thesis's occlusion factor.
vec3 coneRadiance(vec4 cone) {
    vec3 l = cone.rgb;
    if (params.cone_sky) l += (1.0 - cone.a) * sceneInfo.sky;
    return params.multiply_occlusion == MULTIPLY_OCCLUSION_NONE ? l : l * (1.0 - cone.a);
}

// rgb: mean radiance over the hemisphere, cosine-weighted; a: how open it is.
vec4 diffuseCone(ConeOrigin o, vec3 n) {
    ConeSet set = diffuseCones();
    mat3 frame = frameOf(n);
    float turn = 0.0;
    if (params.cone_rotate) // interleaved gradient noise (Jimenez 2014): trades banding for noise
        turn = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < set.count; i++) {
        float angle = 2.0 * PI * (float(i) + turn) / float(set.count - 1);
        vec3 d = i == 0 ? n : frame * vec3(set.sin_tilt * cos(angle), set.sin_tilt * sin(angle), set.cos_tilt);
        float weight = i == 0 ? set.axial_weight : (1.0 - set.axial_weight) / float(set.count - 1);
        vec4 cone = traceCone(o, d, set.tan_half, params.diffuse_steps);
        sum += weight * vec4(coneRadiance(cone), 1.0 - cone.a);
    }
    return sum;
}

vec3 specularCone(ConeOrigin o, Surface s, vec3 face, vec3 v) {
    vec3 d = reflect(-v, s.normal);
    d = normalize(d + face * max(0.02 - dot(d, face), 0.0)); // mapped normals may reflect into the surface
    // Half of a GGX lobe lies within 2 atan(alpha) of the mirror direction; the thesis takes 0.1 pi roughness
    // for the whole aperture.
    float half_angle = params.specular_aperture == SPECULAR_APERTURE_THESIS ? 0.05 * PI * s.roughness
                                                                            : min(2.0 * atan(s.roughness * s.roughness), PI / 3.0);
    vec3 l = coneRadiance(traceCone(o, d, tan(half_angle), params.specular_steps));
    if (params.specular_weight == SPECULAR_WEIGHT_PLAIN) return l; // as the thesis adds it
    return l * environmentBrdf(s.f0, s.roughness, max(dot(s.normal, v), 0.0));
}

void main() {
    Material m = materials.materials[material];
    Gradient g = Gradient(dFdx(uv), dFdy(uv));
    vec3 v = normalize(camera.position - position);
    vec3 face = cross(dFdx(position), dFdy(position));
    face = dot(face, face) > 0.0 ? normalize(face) : normalize(normal);
    face = dot(face, v) < 0.0 ? -face : face;
    // Derivatives end here. Helper invocations at the edges of triangles cover nothing and need no cones.
    if (gl_SampleMaskIn[0] == 0) return;
    vec2 rm = roughnessMetallic(m, uv, g);
    Surface s = makeSurface(shadingNormal(m, g, face), baseColor(m, uv, g).rgb, rm.x, rm.y);

    vec3 light = directLight(s, face, v);
    ConeOrigin o = coneOrigin(position, face, s.normal);
    vec4 hemisphere = diffuseCone(o, params.cone_normal == CONE_NORMAL_MAPPED ? s.normal : face);
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
