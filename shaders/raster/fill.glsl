// Fills the pixels of pieces. The including shader defines
// - targetOf: where a layer is drawn, in two words; targetSize: its pixels
// - targetFootprint (see modules/pixel.glsl)
// - isNearer: whether a depth is not hidden yet; plot: a write with depth test
#ifndef RASTER_FILL_GLSL
#define RASTER_FILL_GLSL
#include "common/scene.glsl"
#include "materials/materials.glsl"
#include "raster/pieces.glsl"
#include "raster/triangles.glsl"

// Texture coordinates and vertex alpha of a piece's plane at a screen position.
vec3 lookupAt(Piece p, Outline o, vec2 at) {
    vec3 b = vec3(edgeAt(o.edges[0], at), edgeAt(o.edges[1], at), edgeAt(o.edges[2], at))
        * vec3(p.per_w[0], p.per_w[1], p.per_w[2]);
    float alpha = COLORS ? dot(b, unpackUnorm4x8(p.alphas).xyz) : 0.0;
    return vec3(b.x * p.uv[0] + b.y * p.uv[1] + b.z * p.uv[2], alpha) / (b.x + b.y + b.z);
}

bool isCutOut(Piece p, Outline o, vec2 at) {
    Material m = materials.materials[p.mask - 1];
    vec3 here = lookupAt(p, o, at);
    vec2 x = targetFootprint() * (lookupAt(p, o, at + vec2(1, 0)).xy - here.xy),
        y = targetFootprint() * (lookupAt(p, o, at + vec2(0, 1)).xy - here.xy);
    return baseColor(m, Interpolants(here.xyxy, here.zzzz), Gradient(x.xyxy, y.xyxy)).a < m.alpha_cutoff;
}

// Fills a pixel with its centre inside.
void fillInside(Piece p, Outline o, ivec2 pixel) {
    vec2 steps = vec2(pixel - o.low);
    precise float depth = clamp(p.depth + p.slope.x * steps.x + p.slope.y * steps.y, p.range.x, p.range.y);
    // Tests depth only to save a mask lookup: plot tests it anyway, without waiting.
    if (p.mask > 0 && (!isNearer(pixel, p.target, depth) || isCutOut(p, o, vec2(pixel) + 0.5))) return;
    plot(pixel, p.target, depth, p.triangle);
}

void fillPixel(Piece p, Outline o, ivec2 pixel) {
    vec2 at = vec2(pixel) + 0.5;
    vec3 e = vec3(edgeAt(o.edges[0], at), edgeAt(o.edges[1], at), edgeAt(o.edges[2], at));
    if (isInside(o.edges[0], e.x) && isInside(o.edges[1], e.y) && isInside(o.edges[2], e.z))
        fillInside(p, o, pixel);
}

void fillRectangle(Piece p, Outline o, ivec2 low, ivec2 high) {
    for (int y = low.y; y <= high.y; y++)
        for (int x = low.x; x <= high.x; x++) fillPixel(p, o, ivec2(x, y));
}

#endif
