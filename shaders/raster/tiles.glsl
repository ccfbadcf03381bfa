// Fills the tiles, 32 threads a tile, 8x4 pixels at a time: as many tiles at once as there is room for, because each begins with a
// chain of lookups.
#include "raster/fill.glsl"

const uint TILE_THREADS = 32;

layout(local_size_x = 4 * TILE_THREADS) in;

void main() {
    uint count = min(rasterCounter.tiles, rasterTiles.list.length()), at_once = gl_WorkGroupSize.x / TILE_THREADS;
    uint number = gl_LocalInvocationID.x / TILE_THREADS, thread = gl_LocalInvocationID.x % TILE_THREADS;
    ivec2 lane = ivec2(thread % 8u, thread / 8u);
    for (uint i = gl_WorkGroupID.x * at_once + number; i < count; i += gl_NumWorkGroups.x * at_once) {
        uvec2 entry = rasterTiles.list[i];
        Piece p = rasterPieces.list[entry.x];
        Outline o;
        if (!outlineOf(p, targetSize(), o)) continue;
        ivec2 corner = ivec2(entry.y & 0xffffu, entry.y >> 16) * TILE;
        for (int y = corner.y; y < corner.y + TILE; y += 4)
            for (int x = corner.x; x < corner.x + TILE; x += 8) {
                if (!meetsRectangle(o, ivec2(x, y), ivec2(8, 4))) continue;
                ivec2 pixel = ivec2(x, y) + lane;
                if (all(greaterThanEqual(pixel, o.low)) && all(lessThanEqual(pixel, o.high))) fillPixel(p, o, pixel);
            }
    }
}
