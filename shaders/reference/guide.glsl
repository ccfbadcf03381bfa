// Where light comes from, learned before the first sample: for each cell of a grid and each of six sides of
// surfaces, shares of 64 bins of a hemisphere (after Mueller, Gross and Novak 2017, "Practical Path Guiding",
// with bins of equal irradiance instead of trees). Half of the diffuse directions follow the shares and half
// the cosine, and the density of both together keeps the mean.
#ifndef REFERENCE_GUIDE_GLSL
#define REFERENCE_GUIDE_GLSL
#include "reference/hit.glsl"
#include "common/ggx.glsl"

const uint GUIDE_BINS = 64; // 8 of the squared sine, times 8 of the angle

// For each distribution, ends of its bins from 0 to 1.
layout(std430) readonly buffer GuideEnds { float ends[]; } guideEnds;

// The distribution of a surface. face: its normal.
uint guideOf(vec3 p, vec3 face) {
    BvhNode root = bvhNodes.nodes[0];
    vec3 extent = root.high - root.low;
    float edge = max(extent.x, max(extent.y, extent.z)) / float(params.guide_cells);
    uvec3 cell = uvec3(clamp(ivec3((p - root.low) / edge), ivec3(0), ivec3(params.guide_cells - 1)));
    vec3 a = abs(face);
    uint axis = a.x > a.y ? (a.x > a.z ? 0 : 2) : (a.y > a.z ? 1 : 2);
    uint side = 2 * axis + (face[axis] < 0.0 ? 1 : 0);
    uint cells = uint(params.guide_cells);
    return ((cell.z * cells + cell.y) * cells + cell.x) * 6 + side;
}

// Coordinates around the side's axis, and back.
vec3 toSide(uint guide, vec3 d) {
    uint side = guide % 6, axis = side / 2;
    return vec3(d[(axis + 1) % 3], d[(axis + 2) % 3], side % 2 == 0 ? d[axis] : -d[axis]);
}

vec3 fromSide(uint guide, vec3 v) {
    uint side = guide % 6, axis = side / 2;
    vec3 d;
    d[axis] = side % 2 == 0 ? v.z : -v.z;
    d[(axis + 1) % 3] = v.x;
    d[(axis + 2) % 3] = v.y;
    return d;
}

// v: around the side's axis.
uint guideBin(vec3 v) {
    vec2 at = vec2(max(1.0 - v.z * v.z, 0.0), fract(atan(v.y, v.x) / (2.0 * PI) + 1.0));
    uvec2 bin = min(uvec2(8.0 * at), uvec2(7));
    return 8 * bin.y + bin.x;
}

bool isGuided() {
#ifdef LEARNS
    return false;
#else
    return params.learning > 1;
#endif
}

float guideEnd(uint guide, uint bin) {
    return bin == 0 ? 0.0 : guideEnds.ends[guide * GUIDE_BINS + bin - 1];
}

// A direction by the shares. u: two numbers in [0, 1).
vec3 guideDirection(uint guide, vec2 u) {
    uint low = 0, high = GUIDE_BINS - 1;
    while (low < high) {
        uint middle = (low + high) / 2;
        if (guideEnd(guide, middle + 1) > u.x) high = middle;
        else low = middle + 1;
    }
    float begin = guideEnd(guide, low), width = max(guideEnd(guide, low + 1) - begin, 1e-9);
    vec2 within = vec2(min((u.x - begin) / width, 0.999999), u.y);
    return fromSide(guide, cosineSample((vec2(low % 8, low / 8) + within) / 8.0));
}

// Pdf of diffuseDirection at d [1/sr].
float diffuseDirectionDensity(uint guide, Surface s, vec3 d) {
    float by_cosine = diffuseDensity(s, d);
    if (!isGuided()) return by_cosine;
    vec3 v = toSide(guide, d);
    if (v.z <= 0.0) return 0.5 * by_cosine;
    uint bin = guideBin(v);
    float share = guideEnd(guide, bin + 1) - guideEnd(guide, bin);
    return 0.5 * (by_cosine + share * float(GUIDE_BINS) * v.z / PI);
}

// Whether diffuseDirection samples the cosine.
bool isByCosine(float u) {
    return !isGuided() || u < 0.5;
}

// A direction for diffuse reflection, its weight (BRDF * cosine / pdf) and its pdf.
LobeSample diffuseDirection(uint guide, SurfaceHit h, vec2 u, out float density) {
    bool by_cosine = isByCosine(u.x);
    if (isGuided()) u.x = fract(2.0 * u.x);
    vec3 d = by_cosine ? frameOf(h.surface.normal) * cosineSample(u) : guideDirection(guide, u);
    density = diffuseDirectionDensity(guide, h.surface, d);
    float cosine = dot(h.surface.normal, d);
    bool above = cosine > 0.0 && dot(d, h.face) > 0.0;
    return LobeSample(d, above ? diffuseBrdf(h.surface) * cosine / density : vec3(0.0));
}

#endif
