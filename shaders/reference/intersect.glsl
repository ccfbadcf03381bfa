// The hierarchy of triangles, and intersection of a ray with its boxes and triangles.
#ifndef REFERENCE_INTERSECT_GLSL
#define REFERENCE_INTERSECT_GLSL

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

#endif
