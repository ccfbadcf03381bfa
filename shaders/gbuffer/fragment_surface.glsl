// Surface of a fragment of gbuffer/surface.vert.
#ifndef SURFACE_GLSL
#define SURFACE_GLSL
#include "common/pixel.glsl"
#include "materials/materials.glsl"
#include "common/brdf.glsl"
#include "materials/normals.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec4 uv;
layout(location = 4) flat in uint material;
layout(location = 5) in vec4 color;
layout(location = 6) in vec3 motion; // since the last frame [m]

Interpolants interpolants() {
    return Interpolants(uv, color);
}

// Uses derivatives: call it before any return.
Gradient gradientHere() {
    return Gradient(PIXEL_FOOTPRINT * dFdx(uv), PIXEL_FOOTPRINT * dFdy(uv));
}

// The triangle's normal on the viewer's side. Uses derivatives: call it before any return.
vec3 faceNormal(vec3 v) {
    vec3 face = cross(dFdx(position), dFdy(position));
    face = dot(face, face) > 0.0 ? normalize(face) : normalize(normal);
    return dot(face, v) < 0.0 ? -face : face;
}

vec3 shadingNormal(Material m, Gradient g, vec3 face) {
    return mappedNormal(m, interpolants(), g, normal, tangent, face);
}

Surface surfaceAt(Material m, Gradient g, vec3 face, vec3 v) {
    vec2 rm = roughnessMetallic(m, interpolants(), g);
    return makeSurface(shadingNormal(m, g, face), baseColor(m, interpolants(), g).rgb, rm.x, rm.y,
        dielectric(m), v);
}

#endif
