// The surface that each pixel sees, between the pass that writes it (surfaces.frag) and those that shade it. Every value
// is 0 or more: where triangles meet in one depth the larger one stays, channel by channel, whatever their order. What is
// then shaded may be a mixture of both, on the viewer's side.
#ifndef SEEN_GLSL
#define SEEN_GLSL
#include "scene.glsl"
#include "brdf.glsl"

struct Seen {
    bool any; // or the background
    vec3 position;
    vec3 face; // geometric normal
    vec3 to_viewer;
    Surface surface;
    vec3 emission;
};

// Octahedral map of the unit sphere to [0,1]^2 (Cigolle et al. 2014).
vec2 packNormal(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    if (n.z < 0.0) p = (1.0 - abs(p.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(p, vec2(0.0)));
    return p * 0.5 + 0.5;
}

vec3 unpackNormal(vec2 p) {
    p = p * 2.0 - 1.0;
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(n.xy, vec2(0.0)));
    return normalize(n);
}

#ifdef READ_SEEN
uniform sampler2D surfaceBase; // base colour, roughness
uniform sampler2D surfaceNormals; // packed: shading, geometric
uniform sampler2D surfaceEmission; // radiance, metallic
uniform sampler2D surfaceDistance; // from the camera [m]; 0: background

// Unit vector through a point of the picture. From the view and projection apart: their product's inverse has lost the
// digits that a short shadow bias needs.
vec3 viewRay(vec2 pixel) {
    vec2 clip = pixel / vec2(camera.size) * 2.0 - 1.0;
    vec3 d = vec3(clip.x / camera.projection[0][0], clip.y / camera.projection[1][1], -1.0);
    return normalize(transpose(mat3(camera.view)) * d);
}

Seen seenAt(ivec2 pixel) {
    Seen seen;
    float range = texelFetch(surfaceDistance, pixel, 0).r;
    seen.any = range > 0.0;
    if (!seen.any) return seen;
    vec3 ray = viewRay(vec2(pixel) + 0.5);
    vec4 base = texelFetch(surfaceBase, pixel, 0), normals = texelFetch(surfaceNormals, pixel, 0);
    vec4 emission = texelFetch(surfaceEmission, pixel, 0);
    seen.position = camera.position + range * ray;
    seen.to_viewer = -ray;
    seen.face = unpackNormal(normals.zw);
    if (dot(seen.face, ray) > 0.0) seen.face = -seen.face;
    vec3 normal = unpackNormal(normals.xy);
    if (dot(normal, seen.face) < -0.5) normal = -normal; // mapped normals lean, mixtures may point anywhere
    seen.surface = makeSurface(normal, base.rgb, base.a, emission.a);
    seen.emission = emission.rgb;
    return seen;
}
#endif

#endif
