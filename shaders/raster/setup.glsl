// Triangle setup, a thread per triangle and LAYERS layers: near clipping, projection, and fill of small
// triangles. The including shader also defines targetTriangles (the first, and the end), targetLayers (their
// number), targetClip (clip position) and targetNear (least w).
#include "raster/fill.glsl"

layout(local_size_x = 64) in;

struct Corner {
    vec4 clip;
    vec2 uv; // of the mask
    float alpha; // of the vertex
};

// Depth, linear over the screen in [-1,1]. From before near clipping: clipped corners project far outside.
vec3 depthPlane(Corner a, Corner b, Corner c) {
    vec3 from = a.clip.xyw;
    precise vec3 e = b.clip.xyw - from, f = c.clip.xyw - from, normal = cross(e, f);
    precise vec3 sum =
        a.clip.z * normal + (b.clip.z - a.clip.z) * cross(f, from) + (c.clip.z - a.clip.z) * cross(from, e);
    return sum / dot(normal, from);
}

void draw(Corner a, Corner b, Corner c, vec3 plane, uint triangle, uint layer, uint mask) {
    Piece p;
    p.target = targetOf(layer);
    ivec2 size = targetSize(p.target);
    p.uv = vec2[3](a.uv, b.uv, c.uv);
    if (COLORS) p.alphas = packUnorm4x8(vec4(a.alpha, b.alpha, c.alpha, 0.0));
    p.triangle = triangle;
    p.mask = mask;
    vec4 clip[3] = vec4[3](a.clip, b.clip, c.clip);
    float depths[3];
    for (int i = 0; i < 3; i++) {
        precise vec2 pixel = (clip[i].xy / clip[i].w * 0.5 + 0.5) * vec2(size);
        p.corner[i] = pixel;
        p.per_w[i] = 1.0 / clip[i].w;
        depths[i] = clamp(clip[i].z / clip[i].w, 0.0, 1.0);
    }
    Outline o;
    if (!outlineOf(p, size, o)) return;
    vec2 first = (vec2(o.low) + 0.5) / vec2(size) * 2.0 - 1.0;
    precise float depth = plane.x * first.x + plane.y * first.y + plane.z;
    p.depth = depth;
    p.slope = plane.xy * 2.0 / vec2(size);
    p.range = vec2(min(depths[0], min(depths[1], depths[2])), max(depths[0], max(depths[1], depths[2])));
    ivec2 edge = o.high - o.low + 1;
    if (edge.x * edge.y > SMALL) {
        bool large = edge.x * edge.y > MEDIUM;
        uint i = large ? atomicAdd(rasterCounter.large, 1) : atomicAdd(rasterCounter.pieces, 1);
        if (i < roomOfPieces(large)) {
            rasterPieces.list[large ? roomOfPieces(false) + i : i] = p;
            return;
        }
    }
    fillRectangle(p, o, o.low, o.high);
}

// Clips the edge from a corner in front of the near plane to one behind it. Starts at the same end for both
// adjacent triangles.
Corner cut(Corner before, Corner behind, float near) {
    precise float t = (before.clip.w - near) / (before.clip.w - behind.clip.w);
    precise vec4 clip = before.clip + t * (behind.clip - before.clip);
    return Corner(vec4(clip.xyz, near), mix(before.uv, behind.uv, t),
        COLORS ? mix(before.alpha, behind.alpha, t) : 1.0);
}

// Whether a triangle may be seen in a layer.
bool isSeen(vec3 world[3], uint layer) {
    vec4 clip[3];
    for (int i = 0; i < 3; i++) clip[i] = targetClip(world[i], layer);
    vec3 w = vec3(clip[0].w, clip[1].w, clip[2].w);
    for (int k = 0; k < 2; k++) {
        vec3 x = vec3(clip[0][k], clip[1][k], clip[2][k]);
        if (all(greaterThan(x, w)) || all(lessThan(x, -w))) return false;
    }
    return any(greaterThanEqual(w, vec3(targetNear(layer))));
}

void setUp(uint triangle, uvec2 t, Draw d, vec3 world[3], uint layer) {
    Corner corner[3];
    for (int i = 0; i < 3; i++) corner[i] = Corner(targetClip(world[i], layer), vec2(0.0), 1.0);
    float near = targetNear(layer);
    uint before = 0;
    for (int i = 0; i < 3; i++) before |= uint(corner[i].clip.w >= near) << i;
    if (before == 0) return; // isSeen may round otherwise
    bool masked = materials.materials[d.material].alpha_cutoff > 0.0;
    if (masked) {
        bool second = usesSecondSet(materials.materials[d.material].base_color_texture);
        for (int i = 0; i < 3; i++) {
            VertexAttributes v = loadAttributes(indices.indices[t.y + i]);
            corner[i].uv = second ? v.uv.zw : v.uv.xy;
            if (COLORS) corner[i].alpha = v.color.a;
        }
    }
    vec3 plane = depthPlane(corner[0], corner[1], corner[2]);
    Corner parts[6];
    for (int i = 0; i < 3; i++) parts[i] = corner[i];
    int count = 1;
    if (before != 7) {
        bool one = bitCount(before) == 1;
        int odd = findLSB(one ? before : 7u & ~before); // the corner that is alone on its side
        Corner a = corner[odd], b = corner[(odd + 1) % 3], c = corner[(odd + 2) % 3];
        if (one) {
            parts[0] = a;
            parts[1] = cut(a, b, near);
            parts[2] = cut(a, c, near);
        } else {
            parts[0] = parts[3] = b;
            parts[1] = c;
            parts[2] = parts[4] = cut(c, a, near);
            parts[5] = cut(b, a, near);
            count = 2;
        }
    }
    for (int i = 0; i < 3 * count; i += 3)
        draw(parts[i], parts[i + 1], parts[i + 2], plane, triangle, layer, masked ? d.material + 1 : 0);
}

void main() {
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    uvec2 range = targetTriangles();
    uint first = gl_GlobalInvocationID.y * LAYERS, many = min(targetLayers() - first, LAYERS);
    for (uint i = range.x + gl_GlobalInvocationID.x; i < range.y; i += stride) {
        uvec2 t = triangles.list[i];
        Draw d = draws.draws[t.x];
        vec3 world[3];
        for (int k = 0; k < 3; k++) world[k] = toWorld(d.instance, loadPosition(indices.indices[t.y + k]));
        // A triangle is in few layers, neighbours in different ones: first find them, then set all up at once.
        uint seen = 0;
        for (uint k = 0; k < many; k++) seen |= uint(isSeen(world, first + k)) << k;
        for (; seen != 0; seen &= seen - 1) setUp(i, t, d, world, first + findLSB(seen));
    }
}
