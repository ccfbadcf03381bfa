// Fills tiles, 32 threads per tile. Each thread finds the coverage of one 8x4 block; then all fill one block
// after another. A group handles several tiles, which hides the chain of lookups at the start of each.
#include "raster/fill.glsl"

const uint TILE_THREADS = 32, TILES = 4; // per group
const ivec2 BLOCK = ivec2(8, 4); // TILE_THREADS pixels; a tile has TILE_THREADS blocks

layout(local_size_x = TILES * TILE_THREADS) in;

shared uint covered[TILES * TILE_THREADS];

ivec2 blockCorner(uint block) {
    return BLOCK * ivec2(block % 4u, block / 4u);
}

void main() {
    uint count = min(rasterCounter.tiles, rasterTiles.list.length()),
        number = gl_LocalInvocationID.x / TILE_THREADS,
        thread = gl_LocalInvocationID.x % TILE_THREADS;
    ivec2 lane = ivec2(thread % 8u, thread / 8u);
    for (uint start = gl_WorkGroupID.x * TILES; start < count; start += gl_NumWorkGroups.x * TILES) {
        Piece p;
        Outline o;
        ivec2 corner;
        uint mine = OUTSIDE;
        if (start + number < count) {
            uvec2 entry = rasterTiles.list[start + number];
            p = rasterPieces.list[entry.x];
            corner = ivec2(entry.y & 0xffffu, entry.y >> 16) * TILE;
            if (outlineOf(p, targetSize(p.target), o)) mine = coverage(o, corner + blockCorner(thread), BLOCK);
        }
        covered[gl_LocalInvocationID.x] = mine;
        barrier();
        for (uint block = 0; block < TILE_THREADS; block++) {
            uint how = covered[number * TILE_THREADS + block];
            ivec2 pixel = corner + blockCorner(block) + lane;
            if (how == INSIDE) fillInside(p, o, pixel);
            else if (how == CROSSED
                && all(greaterThanEqual(pixel, o.low)) && all(lessThanEqual(pixel, o.high)))
                fillPixel(p, o, pixel);
        }
        barrier();
    }
}
