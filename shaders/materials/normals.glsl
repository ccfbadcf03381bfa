// Shading normal: interpolated, perturbed by the normal map, on the visible side of the face.
#ifndef NORMALS_GLSL
#define NORMALS_GLSL
#include "materials/materials.glsl"

// normal, tangent: interpolated, in world space; tangent.w: sign of the bitangent.
vec3 mappedNormal(Material m, Interpolants at, Gradient g, vec3 normal, vec4 tangent, vec3 face) {
    vec3 n = normalize(normal);
    float side = dot(n, face) < 0.0 ? -1.0 : 1.0; // back faces of two-sided surfaces
    if (m.normal_texture != NO_TEXTURE) {
        vec3 t = tangentNormal(m, at, g);
        vec3 x = tangent.xyz - n * dot(n, tangent.xyz);
        if (dot(x, x) > 1e-12) {
            x = normalize(x);
            n = normalize(mat3(x, cross(n, x) * sign(tangent.w), n) * t);
        }
    }
    return n * side;
}

#endif
