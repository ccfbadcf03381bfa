// Ray tracing of the scene's triangles with a binary hierarchy in world space, for this frame's pose. Rays
// pass through the holes of alpha masks.
#ifndef TRACE_GLSL
#define TRACE_GLSL
#include "common/scene.glsl"
#include "materials/materials.glsl"
#include "reference/intersect.glsl"

struct Corners {
    uvec3 vertices;
    uint instance;
    uint material;
};

Corners cornersOf(BvhTriangle t) {
    Draw draw = draws.draws[t.draw];
    uint i = t.first_index;
    return Corners(uvec3(indices.indices[i], indices.indices[i + 1], indices.indices[i + 2]), draw.instance,
        draw.material);
}

// Weights of b and c at the intersection of a line with the triangle's plane.
vec2 planeWeights(BvhTriangle t, vec3 origin, vec3 d) {
    vec3 ab = t.b - t.a, ac = t.c - t.a, n = cross(ab, ac);
    vec3 p = origin + d * (dot(n, t.a - origin) / dot(n, d)) - t.a;
    return vec2(dot(cross(p, ac), n), dot(cross(ab, p), n)) / dot(n, n);
}

vec4 mixCorners(vec4 a, vec4 b, vec4 c, vec2 weights) {
    return a + weights.x * (b - a) + weights.y * (c - a);
}

// Texture coordinates and vertex colour at a hit, and the gradients of the coordinates.
Interpolants interpolantsOf(Material m, BvhTriangle t, Corners corners, vec2 weights, Footprint f,
    out Gradient gradient) {
    VertexAttributes a = loadAttributes(corners.vertices.x),
        b = loadAttributes(corners.vertices.y),
        c = loadAttributes(corners.vertices.z);
    Interpolants at = Interpolants(mixCorners(a.uv, b.uv, c.uv, weights), vec4(1.0));
    if (isColored(m)) at.color = mixCorners(a.color, b.color, c.color, weights);
    gradient = Gradient(vec4(0.0), vec4(0.0));
    if (f.x != vec3(0.0))
        gradient = Gradient(mixCorners(a.uv, b.uv, c.uv, planeWeights(t, f.origin, f.x)) - at.uv,
            mixCorners(a.uv, b.uv, c.uv, planeWeights(t, f.origin, f.y)) - at.uv);
    return at;
}

bool cutOut(BvhTriangle t, vec2 weights, Footprint f) {
    Corners corners = cornersOf(t);
    Material m = materials.materials[corners.material];
    Gradient g;
    Interpolants at = interpolantsOf(m, t, corners, weights, f, g);
    return baseColor(m, at, g).a < m.alpha_cutoff;
}

Hit traceRay(Ray ray, Footprint f, bool any) {
    Hit hit = Hit(ray.end, NO_HIT, vec2(0.0));
    Shear shear = shearOf(ray.direction);
    vec3 d = mix(ray.direction, vec3(1e-20), equal(ray.direction, vec3(0.0)));
    vec3 inverse = 1.0 / d;
    uint stack[TRACE_STACK];
    int depth = 0;
    uint at = 0;
    if (hitBox(bvhNodes.nodes[0], ray.origin, inverse, hit.t) < 0.0) return hit;
    while (true) {
        BvhNode node = bvhNodes.nodes[at];
        if (node.count == 0) {
            uint left = node.first, right = node.first + 1;
            float l = hitBox(bvhNodes.nodes[left], ray.origin, inverse, hit.t);
            float r = hitBox(bvhNodes.nodes[right], ray.origin, inverse, hit.t);
            if (l >= 0.0 && r >= 0.0) {
                stack[depth++] = l <= r ? right : left;
                at = l <= r ? left : right;
                continue;
            }
            if (l >= 0.0 || r >= 0.0) {
                at = l >= 0.0 ? left : right;
                continue;
            }
        } else {
            for (uint i = node.first; i < node.first + node.count; i++) {
                BvhTriangle t = bvhTriangles.triangles[i];
                Hit found;
                if (!hitTriangle(shear, ray.origin, t, hit.t, found)) continue;
                if ((t.flags & MASKED) != 0 && cutOut(t, found.weights, f)) continue;
                hit = Hit(found.t, i, found.weights);
                if (any) return hit;
            }
        }
        if (depth == 0) return hit;
        at = stack[--depth];
    }
    return hit;
}

bool blocked(Ray ray) {
    return traceRay(ray, NO_FOOTPRINT, true).triangle != NO_HIT;
}

// A point just off a surface, by more than the rounding of p (Waechter and Binder 2019, "A Fast and Robust
// Method for Avoiding Self-Intersection"). n: geometric normal on the starting side.
vec3 offsetPoint(vec3 p, vec3 n) {
    ivec3 steps = ivec3(256.0 * n);
    vec3 moved = intBitsToFloat(floatBitsToInt(p) + mix(steps, -steps, lessThan(p, vec3(0.0))));
    return mix(moved, p + n / 65536.0, lessThan(abs(p), vec3(1.0 / 32.0)));
}

#endif
