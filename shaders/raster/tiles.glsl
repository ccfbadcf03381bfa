// Fills the tiles, a group a tile, 8x8 pixels at a time.
#include "raster/fill.glsl"

layout(local_size_x = 64) in;

void main() {
    uint count = min(rasterCounter.tiles, rasterTiles.list.length());
    ivec2 lane = ivec2(gl_LocalInvocationID.x % 8u, gl_LocalInvocationID.x / 8u);
    for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
        uvec2 entry = rasterTiles.list[i];
        Piece p = rasterPieces.list[entry.x];
        Outline o;
        if (!outlineOf(p, targetSize(), o)) continue;
        Material m = materialOf(p.triangle);
        ivec2 corner = ivec2(entry.y & 0xffffu, entry.y >> 16) * TILE;
        for (int y = corner.y; y < corner.y + TILE; y += 8)
            for (int x = corner.x; x < corner.x + TILE; x += 8) {
                if (!meetsRectangle(o, ivec2(x, y), ivec2(8))) continue;
                ivec2 pixel = ivec2(x, y) + lane;
                if (all(greaterThanEqual(pixel, o.low)) && all(lessThanEqual(pixel, o.high))) fillPixel(p, o, m, pixel);
            }
    }
}
