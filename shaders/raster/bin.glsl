// Bins large pieces into tiles, one group per piece. A group fills medium pieces itself, because their tiles
// would cost more.
#include "raster/fill.glsl"

layout(local_size_x = 32) in;

// One atomic per group on the queue's length: a hundred thousand threads would wait for each other.
shared uint found;
shared uint first_entry;

void main() {
    uint count = queuedPieces();
    for (uint n = gl_WorkGroupID.x; n < count; n += gl_NumWorkGroups.x) {
        uint i = queuedPiece(n);
        Piece p = rasterPieces.list[i];
        Outline o;
        outlineOf(p, targetSize(p.target), o); // true for all queued pieces
        if ((o.high.x - o.low.x + 1) * (o.high.y - o.low.y + 1) <= MEDIUM) {
            ivec2 lane = ivec2(gl_LocalInvocationIndex & 7u, gl_LocalInvocationIndex >> 3);
            for (int y = o.low.y; y <= o.high.y; y += 4)
                for (int x = o.low.x; x <= o.high.x; x += 8) {
                    ivec2 pixel = ivec2(x, y) + lane;
                    if (all(lessThanEqual(pixel, o.high))) fillPixel(p, o, pixel);
                }
            continue;
        }
        ivec2 first = o.low / TILE, tiles = o.high / TILE - first + 1;
        int many = tiles.x * tiles.y;
        for (int start = 0; start < many; start += int(gl_WorkGroupSize.x)) {
            if (gl_LocalInvocationIndex == 0) found = 0;
            barrier();
            int t = start + int(gl_LocalInvocationIndex);
            ivec2 tile = first + ivec2(t % tiles.x, t / tiles.x);
            bool meets = t < many && coverage(o, tile * TILE, ivec2(TILE)) != OUTSIDE;
            uint mine = meets ? atomicAdd(found, 1) : 0;
            barrier();
            if (gl_LocalInvocationIndex == 0) first_entry = atomicAdd(rasterCounter.tiles, found);
            barrier();
            if (!meets) continue;
            uint k = first_entry + mine;
            if (k < rasterTiles.list.length()) {
                rasterTiles.list[k] = uvec2(i, uint(tile.x | tile.y << 16));
            } else {
                ivec2 corner = tile * TILE;
                fillRectangle(p, o, max(o.low, corner), min(o.high, corner + TILE - 1));
            }
        }
    }
}
