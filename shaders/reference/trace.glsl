// Ray tracing of the scene's triangles with a binary hierarchy in world space, for this frame's pose. Rays
// pass through the holes of alpha masks.
#ifndef TRACE_GLSL
#define TRACE_GLSL
#include "common/scene.glsl"
#include "common/materials.glsl"

struct BvhNode {
    vec3 low;
    uint count; // triangles; 0: an inner node
    vec3 high;
    uint first; // triangle, or the first of two children
};

struct BvhTriangle {
    vec3 a; // world
    uint draw;
    vec3 b;
    uint first_index; // of its three vertices in `indices`
    vec3 c;
    // Highest bit: alpha mask. For emitters: index of the first part plus 1; from bit 24, the number of parts
    // along an edge.
    uint flags;
};

const uint MASKED = 0x80000000u;

layout(std430) readonly buffer BvhNodes { BvhNode nodes[]; } bvhNodes;
layout(std430) readonly buffer BvhTriangles { BvhTriangle triangles[]; } bvhTriangles;
layout(std430) readonly buffer Indices { uint indices[]; } indices;

const uint NO_HIT = 0xffffffffu;
const int TRACE_STACK = 64; // the program rejects scenes with a deeper hierarchy

struct Ray {
    vec3 origin;
    vec3 direction; // unit length
    float end; // [m]
};

struct Hit {
    float t;
    uint triangle; // NO_HIT: none
    vec2 weights; // of the corners b and c
};

// Rays through the neighbouring pixels, for texture gradients; zero after the first hit.
struct Footprint {
    vec3 origin;
    vec3 x;
    vec3 y;
};

const Footprint NO_FOOTPRINT = Footprint(vec3(0.0), vec3(0.0), vec3(0.0));

// Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection": no ray slips between triangles that
// share an edge. Precomputed per ray: axes with z the longest, and the shear that maps the ray to (0, 0, 1).
struct Shear {
    ivec3 axes;
    vec3 s;
};

Shear shearOf(vec3 d) {
    vec3 a = abs(d);
    int z = a.x > a.y ?
        (a.x > a.z ? 0 : 2) :
        (a.y > a.z ? 1 : 2);
    ivec3 axes = ivec3((z + 1) % 3, (z + 2) % 3, z);
    return Shear(axes, vec3(d[axes.x], d[axes.y], 1.0) / d[z]);
}

bool hitTriangle(Shear shear, vec3 origin, BvhTriangle t, float end, out Hit hit) {
    vec3 a = t.a - origin, b = t.b - origin, c = t.c - origin;
    ivec3 k = shear.axes;
    precise vec2 pa = vec2(a[k.x], a[k.y]) - shear.s.xy * a[k.z];
    precise vec2 pb = vec2(b[k.x], b[k.y]) - shear.s.xy * b[k.z];
    precise vec2 pc = vec2(c[k.x], c[k.y]) - shear.s.xy * c[k.z];
    // Both triangles at an edge compute the same two products, without contraction: opposite to the bit.
    precise float u = pc.x * pb.y - pc.y * pb.x;
    precise float v = pa.x * pc.y - pa.y * pc.x;
    precise float w = pb.x * pa.y - pb.y * pa.x;
    if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) return false;
    float sum = u + v + w;
    if (sum == 0.0) return false;
    float distance = shear.s.z * (u * a[k.z] + v * b[k.z] + w * c[k.z]) / sum;
    if (!(distance > 0.0 && distance < end)) return false;
    hit.t = distance;
    hit.weights = vec2(v, w) / sum;
    return true;
}

// Distance to the box, or a negative number. Widened by the rounding of its own arithmetic (Ize 2013).
float hitBox(BvhNode node, vec3 origin, vec3 inverse, float end) {
    vec3 a = (node.low - origin) * inverse, b = (node.high - origin) * inverse;
    vec3 near = min(a, b), far = max(a, b) * 1.0000004;
    float enter = max(max(near.x, near.y), max(near.z, 0.0));
    return enter <= min(min(far.x, far.y), min(far.z, end)) ? enter : -1.0;
}

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
Place placeOf(Material m, BvhTriangle t, Corners corners, vec2 weights, Footprint f, out Gradient gradient) {
    VertexAttributes a = loadAttributes(corners.vertices.x),
        b = loadAttributes(corners.vertices.y),
        c = loadAttributes(corners.vertices.z);
    Place at = Place(mixCorners(a.uv, b.uv, c.uv, weights), vec4(1.0));
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
    Place at = placeOf(m, t, corners, weights, f, g);
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
