// Compute rasteriser of triangles (after Schwarz and Seidel 2010; Pantaleoni 2011). The setup thread tests
// the cells of a small triangle. For a large one, one group lists its 4x4x4 bricks, and one group per brick
// tests the cells. If a queue is full, the thread tests the cells at once.
#ifndef VOXELIZE_PIECES_GLSL
#define VOXELIZE_PIECES_GLSL
#include "common/math.glsl"
#include "volume/volume.glsl"
#include "common/scene.glsl"
#include "materials/materials.glsl"
#include "modules/reflectance.glsl"
#include "raster/triangles.glsl"
#include "voxels/store.glsl"
#include "voxels/overlap.glsl"

// A triangle, or its part beyond the near plane of the cells. In flat coordinates, or world space if the map
// has none.
struct VoxelPiece {
    vec3 a;
    uint triangle;
    vec3 b;
    int cascade;
    vec3 c;
    uint columns; // first and last cell along x, + 1024, 16 bits each
};

layout(std430) buffer VoxelPieces { VoxelPiece list[]; } voxelPieces;
layout(std430) buffer VoxelTouched { uvec2 list[]; } voxelTouched; // x: piece; y: brick

const int BRICK = 4;
const int SMALL_CELLS = 16; // largest bounding box that a single thread tests [cells]

// Inclusive range of cells. Across the seam of spheres, x continues below 0 or beyond the last cell.
struct CellRange {
    ivec3 from;
    ivec3 to;
};

CellRange rangeOf(VolumeMap map, VoxelPiece p) {
    vec3 low, high;
    if (isFlat(map)) {
        low = cellsOfFlat(map, min(p.a, min(p.b, p.c))) - 1e-5;
        high = cellsOfFlat(map, max(p.a, max(p.b, p.c))) + 1e-5;
    } else {
        curvedBounds(map, p.a, p.b, p.c, low, high);
    }
    ivec3 last = ivec3(params.voxel_dim - 1);
    CellRange r = CellRange(
        ivec3(floor(clamp(low, -float(params.voxel_dim), 2.0 * float(params.voxel_dim)))),
        ivec3(floor(clamp(high, -float(params.voxel_dim), 2.0 * float(params.voxel_dim)))));
    if (isReprojected(map, low) && isReprojected(map, high)) r.to = r.from - 1; // all reprojected
    ivec3 from = max(r.from, ivec3(0)), to = min(r.to, last);
    if (isFlat(map)) return CellRange(from, to);
    return CellRange(ivec3(r.from.x, from.yz), ivec3(min(r.to.x, r.from.x + last.x), to.yz));
}

// Whether a piece touches the box of cells from `first` to `first + edge`. Curved boxes grow by `margin`
// [cells].
bool touches(VolumeMap map, VoxelPiece p, ivec3 first, ivec3 edge, float margin) {
    if (!isFlat(map))
        return curvedTouches(map, p.a, p.b, p.c, vec3(first) - margin, vec3(first + edge) + margin);
    vec3 low = flatOfCells(map, vec3(first)), size = flatOfCells(map, vec3(first + edge)) - low;
    return triangleOverlapsCell((p.a - low) / size, (p.b - low) / size, (p.c - low) / size, ivec3(0));
}

#include "voxels/store_cell.glsl"

void storeCells(VolumeMap map, VoxelPiece p, CellRange r) {
    for (int z = r.from.z; z <= r.to.z; z++)
        for (int y = r.from.y; y <= r.to.y; y++)
            for (int x = r.from.x; x <= r.to.x; x++)
                if (touches(map, p, ivec3(x, y, z), ivec3(1), 0.0)) storeCell(map, p, ivec3(x, y, z));
}

#endif
