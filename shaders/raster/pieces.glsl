// Triangles as threads draw them, beside the rasteriser (Laine and Karras 2011; Karis et al. 2021): small ones are filled by the
// thread that sets them up; large ones are queued, binned into tiles, and each tile is filled by a group. Where a queue is full,
// who finds it full fills the pixels at once: slower, and nothing is lost.
// Of two triangles that share an edge exactly one covers each pixel centre there: edges are evaluated from the same end, with
// the same operations, wherever they are.
#ifndef RASTER_PIECES_GLSL
#define RASTER_PIECES_GLSL

// A triangle, or a part of one that the near plane cut, on the screen.
struct Piece {
    vec2 corner[3]; // pixels
    float per_w[3]; // 1 / w of clip positions
    vec2 uv[3]; // of the mask
    uint alphas; // of the vertices' colours, a byte each
    float depth; // at the centre of the first pixel of its bounding rectangle
    vec2 slope; // of depth, a pixel
    vec2 range; // of depth
    uint triangle;
    uint layer;
    uint mask; // the material whose alpha cuts holes, + 1; 0: none does
};

layout(std430) buffer RasterPieces { Piece list[]; } rasterPieces;
layout(std430) buffer RasterTiles { uvec2 list[]; } rasterTiles; // piece; tile, its row above its column
layout(std430) buffer RasterCounter {
    uint pieces; // asked for
    uint large; // of those that are more than a group fills alone
    uint tiles;
} rasterCounter;

const int TILE = 32; // edge [pixels]
const int SMALL = 16; // pixels of a bounding rectangle that a thread fills alone
const int MEDIUM = 1024; // that a group fills alone

// The last quarter of the queue is for large pieces: a thread that finds no room fills its piece alone, and of a large one all wait for it.
uint roomOfPieces(bool large) {
    uint room = rasterPieces.list.length() / 4u;
    return large ? room : rasterPieces.list.length() - room;
}

uint queuedPieces() {
    return min(rasterCounter.pieces, roomOfPieces(false)) + min(rasterCounter.large, roomOfPieces(true));
}

// Where the i-th of them lies.
uint queuedPiece(uint i) {
    uint others = min(rasterCounter.pieces, roomOfPieces(false));
    return i < others ? i : roomOfPieces(false) + i - others;
}

struct Edge {
    vec2 from;
    vec2 along;
    float facing; // 1 or -1: on which side inside is
};

struct Outline {
    Edge edges[3]; // opposite the corners
    ivec2 low; // pixels whose centres the bounding rectangle holds
    ivec2 high;
};

Edge edgeOf(vec2 p, vec2 q, float winding) {
    bool swapped = p.x > q.x || p.x == q.x && p.y > q.y;
    vec2 from = swapped ? q : p, to = swapped ? p : q;
    return Edge(from, to - from, swapped ? -winding : winding);
}

// Positive inside. `precise`: the same in every shader, so that neighbours agree.
float edgeAt(Edge e, vec2 p) {
    precise float value = e.along.x * (p.y - e.from.y) - e.along.y * (p.x - e.from.x);
    return value * e.facing;
}

// What lies on an edge belongs to one of its two sides.
bool isInside(Edge e, float value) {
    return value > 0.0 || value == 0.0 && e.facing > 0.0;
}

// False where no pixel's centre can be inside.
bool outlineOf(Piece p, ivec2 size, out Outline o) {
    vec2 e = p.corner[1] - p.corner[0], f = p.corner[2] - p.corner[0];
    precise float area = e.x * f.y - e.y * f.x;
    if (!(abs(area) > 0.0)) return false;
    float winding = sign(area);
    o.edges = Edge[3](edgeOf(p.corner[1], p.corner[2], winding), edgeOf(p.corner[2], p.corner[0], winding), edgeOf(p.corner[0], p.corner[1], winding));
    vec2 low = min(p.corner[0], min(p.corner[1], p.corner[2])), high = max(p.corner[0], max(p.corner[1], p.corner[2]));
    o.low = ivec2(ceil(clamp(low, vec2(0.0), vec2(size)) - 0.5));
    o.high = min(ivec2(floor(clamp(high, vec2(-1.0), vec2(size)) - 0.5)), size - 1);
    return all(lessThanEqual(o.low, o.high));
}

// How much of a rectangle of pixels (first, edge) is inside: of no centre, perhaps of some, of all.
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
