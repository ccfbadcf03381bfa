// The specular lobe as a linearly transformed cosine (Heitz et al. 2016), from the table of
// lights/lobe_shape.comp.
#ifndef LOBE_SHAPE_GLSL
#define LOBE_SHAPE_GLSL
#include "lights/polygon.glsl"
#include "common/frame.glsl"
#include "shade/lobe_albedo.glsl"

uniform sampler2D lobeShape; // x: root of 1 minus the cosine at the viewer, y: roughness

// Maps the lobe of a surface to the cosine around z. The table holds the inverse, (x 0 z; 0 y 0; w 0 1), in
// the frame whose x axis is on the viewer's side.
mat3 lobeSpace(Surface s, vec3 v) {
    vec3 n = s.normal;
    float cosine = dot(n, v);
    vec2 size = vec2(textureSize(lobeShape, 0));
    vec2 at = vec2(sqrt(clamp(1.0 - cosine, 0.0, 1.0)), s.roughness);
    vec4 m = textureLod(lobeShape, (at * (size - 1.0) + 0.5) / size, 0.0);
    vec3 aside = v - cosine * n;
    vec3 x = dot(aside, aside) > 1e-10 ? normalize(aside) : frameOf(n)[0];
    return transpose(mat3(x - m.z * n, cross(n, x) * ((m.x - m.z * m.w) / m.y), m.x * n - m.w * x));
}

// Light of a rectangle or disc that the lobe reflects to the viewer, without shadow. The table knows no
// Fresnel reflectance. A light that fills the lobe has its mean, a small one that of the facets that reflect
// from where it is seen: with the mean alone, rough dielectrics are off by a factor of two at grazing angles.
vec3 lobeLight(Light light, Surface s, vec3 p, vec3 v) {
    mat3 space = lobeSpace(s, v);
    vec3 form = formVector(light, p, space, vec3(0, 0, 1));
    if (form.z <= 0.0) return vec3(0.0);
    vec2 albedo = lobeAlbedo(dot(s.normal, v), s.roughness);
    vec3 whole = lobeReflectance(s, v), lit = whole;
    if (albedo.y > 0.0) { // 0: the shading model has no Fresnel reflectance
        vec3 half_way = unit(v + unit(inverse(space) * form));
        lit = fresnel(s, max(dot(v, half_way), 0.0)) * (albedo.x + albedo.y) * s.multiple;
    }
    return mix(lit, whole, min(form.z, 1.0)) * light.color * form.z;
}

#endif
