// Compute rasteriser (Laine and Karras 2011; Karis et al. 2021). The thread that sets up a small triangle
// fills it. Large triangles are queued and binned into tiles, and a group fills each tile. A thread that
// finds a queue full fills the pixels itself: slower, but nothing is lost.
//
// Exactly one of two triangles that share an edge covers each pixel centre on it: every shader evaluates an
// edge from the same end with the same operations.
#ifndef RASTER_PIECES_GLSL
#define RASTER_PIECES_GLSL

// A triangle in screen space, or a part of one clipped at the near plane.
struct Piece {
    vec2 corner[3]; // pixels
    float per_w[3]; // 1 / w of clip positions
    vec2 uv[3]; // of the mask
    uint alphas; // vertex alpha, a byte each
    float depth; // at the centre of the first pixel of the bounding rectangle
    vec2 slope; // of depth, per pixel
    vec2 range; // of depth
    uint triangle;
    uint mask; // material with an alpha mask, plus 1; 0: none
    uvec2 target; // see targetOf
};

layout(std430) buffer RasterPieces { Piece list[]; } rasterPieces;
layout(std430) buffer RasterTiles { uvec2 list[]; } rasterTiles; // piece; tile: column | row << 16
layout(std430) buffer RasterCounter {
    uint pieces; // requested slots of pieces that a group fills itself; may exceed the queue
    uint large; // requested slots of larger pieces
    uint tiles;
} rasterCounter;

const int TILE = 32; // edge [pixels]
const int SMALL = 16; // largest bounding rectangle that a thread fills itself [pixels]
const int MEDIUM = 1024; // largest that a group fills itself

// The last quarter of the queue is for large pieces: a thread that finds it full fills its piece alone, and
// all threads wait for a large one.
uint roomOfPieces(bool large) {
    uint room = rasterPieces.list.length() / 4u;
    return large ? room : rasterPieces.list.length() - room;
}

uint queuedPieces() {
    return min(rasterCounter.pieces, roomOfPieces(false)) + min(rasterCounter.large, roomOfPieces(true));
}

// Index of queued piece i in the list.
uint queuedPiece(uint i) {
    uint others = min(rasterCounter.pieces, roomOfPieces(false));
    return i < others ? i : roomOfPieces(false) + i - others;
}

struct Edge {
    vec2 from;
    vec2 along;
    float facing; // 1 or -1: the inner side
};

struct Outline {
    Edge edges[3]; // opposite the corners
    ivec2 low; // first and last pixel with its centre in the bounding rectangle
    ivec2 high;
};

Edge edgeOf(vec2 p, vec2 q, float winding) {
    bool swapped = p.x > q.x || p.x == q.x && p.y > q.y;
    vec2 from = swapped ? q : p,
        to = swapped ? p : q;
    return Edge(from, to - from, swapped ? -winding : winding);
}

// Positive inside. `precise` gives the same value in every shader, so that neighbours agree.
float edgeAt(Edge e, vec2 p) {
    precise float value = e.along.x * (p.y - e.from.y) - e.along.y * (p.x - e.from.x);
    return value * e.facing;
}

// A point on an edge belongs to exactly one of its two sides.
bool isInside(Edge e, float value) {
    return value > 0.0 || value == 0.0 && e.facing > 0.0;
}

// Returns false if no pixel centre can be inside.
bool outlineOf(Piece p, ivec2 size, out Outline o) {
    vec2 e = p.corner[1] - p.corner[0], f = p.corner[2] - p.corner[0];
    precise float area = e.x * f.y - e.y * f.x;
    if (!(abs(area) > 0.0)) return false;
    float winding = sign(area);
    o.edges = Edge[3](
        edgeOf(p.corner[1], p.corner[2], winding),
        edgeOf(p.corner[2], p.corner[0], winding),
        edgeOf(p.corner[0], p.corner[1], winding));
    vec2 low = min(p.corner[0], min(p.corner[1], p.corner[2])),
        high = max(p.corner[0], max(p.corner[1], p.corner[2]));
    o.low = ivec2(ceil(clamp(low, vec2(0.0), vec2(size)) - 0.5));
    o.high = min(ivec2(floor(clamp(high, vec2(-1.0), vec2(size)) - 0.5)), size - 1);
    return all(lessThanEqual(o.low, o.high));
}

// Coverage of a rectangle of pixels (first, edge): no centre, perhaps some, or all.
const uint OUTSIDE = 0, CROSSED = 1, INSIDE = 2;

uint coverage(Outline o, ivec2 first, ivec2 edge) {
    vec2 middle = vec2(first) + 0.5 * vec2(edge), half_edge = 0.5 * vec2(edge - 1) + 0.01;
    bool inside = all(greaterThanEqual(first, o.low)) && all(lessThanEqual(first + edge - 1, o.high));
    for (int i = 0; i < 3; i++) {
        Edge e = o.edges[i];
        float value = edgeAt(e, middle), reach = half_edge.x * abs(e.along.y) + half_edge.y * abs(e.along.x);
        if (value + reach < 0.0) return OUTSIDE;
        inside = inside && value > reach;
    }
    return inside ? INSIDE : CROSSED;
}

#endif
