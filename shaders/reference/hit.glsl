// Surface at a ray hit.
#ifndef HIT_GLSL
#define HIT_GLSL
#include "reference/trace.glsl"
#include "common/brdf.glsl"
#include "lights/emitters.glsl"
#include "materials/normals.glsl"

struct SurfaceHit {
    vec3 position;
    vec3 face; // the triangle's normal on the viewer's side
    vec3 view; // to the ray's origin
    Surface surface;
    vec3 emission;
    float drawn; // pdf of an emitter sample here, by area [1/m^2]
};

SurfaceHit surfaceOf(Hit hit, Ray ray, Footprint f) {
    BvhTriangle t = bvhTriangles.triangles[hit.triangle];
    Corners corners = cornersOf(t);
    Material m = materials.materials[corners.material];
    Gradient g;
    Interpolants at = interpolantsOf(m, t, corners, hit.weights, f, g);
    vec3 w = vec3(1.0 - hit.weights.x - hit.weights.y, hit.weights);
    vec3 v = -ray.direction;
    vec3 face = normalize(cross(t.b - t.a, t.c - t.a));
    bool front = dot(face, v) >= 0.0;
    face = front ? face : -face;

    VertexAttributes a = loadAttributes(corners.vertices.x),
        b = loadAttributes(corners.vertices.y),
        c = loadAttributes(corners.vertices.z);
    vec3 normal = normalToWorld(corners.instance, w.x * a.normal + w.y * b.normal + w.z * c.normal);
    vec4 tangent = tangentToWorld(corners.instance, w.x * a.tangent + w.y * b.tangent + w.z * c.tangent);
    vec3 n = mappedNormal(m, at, g, normal, tangent, face);
    vec2 rm = roughnessMetallic(m, at, g);
    Surface s = makeSurface(n, baseColor(m, at, g).rgb, rm.x, rm.y, dielectric(m), v);
    return SurfaceHit(t.a + w.y * (t.b - t.a) + w.z * (t.c - t.a), face, v, s, emission(m, at, g),
        emitterDensity(t.flags, hit.weights, front));
}

#endif
