// Compute rasteriser of triangles (after Schwarz and Seidel 2010; Pantaleoni 2011). The setup thread tests
// the cells of a small triangle. For a large one, one group lists its 4x4x4 bricks, and one group per brick
// tests the cells. If a queue is full, the thread tests the cells at once.
#ifndef VOXELIZE_PIECES_GLSL
#define VOXELIZE_PIECES_GLSL
#include "common/math.glsl"
#include "volume/volume.glsl"
#include "common/scene.glsl"
#include "common/materials.glsl"
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

// Stores a triangle's fragment in a cell: the surface at the point closest to the cell centre, with a texture
// footprint of one cell.
void storeCell(VolumeMap map, VoxelPiece p, ivec3 cell) {
    if (!isFlat(map)) cell.x = (cell.x + params.voxel_dim) % params.voxel_dim;
    if (isReprojected(map, vec3(cell) + 0.5)) return;
    uvec2 t = triangles.list[p.triangle];
    Draw d = draws.draws[t.x];
    uvec3 vertex = uvec3(indices.indices[t.y], indices.indices[t.y + 1], indices.indices[t.y + 2]);
    vec3 a = toWorld(d.instance, loadPosition(vertex.x));
    vec3 e = toWorld(d.instance, loadPosition(vertex.y)) - a,
        f = toWorld(d.instance, loadPosition(vertex.z)) - a;
    vec3 face = cross(e, f),
        middle = volumeToWorld(map, (vec3(cell) + 0.5) / float(params.voxel_dim));
    float area = dot(face, face);
    mat2x3 weights = area > 0.0 ? mat2x3(cross(f, face) / area, cross(face, e) / area) : mat2x3(0.0);
    vec2 at = (middle - a) * weights;
    vec3 b = area > 0.0 ? max(vec3(1.0 - at.x - at.y, at), 0.0) : vec3(1.0);
    b /= b.x + b.y + b.z;

    VertexAttributes v[3] = VertexAttributes[3](loadAttributes(vertex.x), loadAttributes(vertex.y),
        loadAttributes(vertex.z));
    mat3 axes = cellAxes(map, middle);
    vec3 along = face * axes;
    int dominant = int(dominantAxis(along));
    int i = dominant == 0 ? 1 : 0,
        j = dominant == 2 ? 1 : 2;
    mat2x4 uv_of = mat2x4(v[1].uv - v[0].uv, v[2].uv - v[0].uv);
    float per = area > 0.0 ? 1.0 / along[dominant] : 0.0;
    Gradient g = Gradient(uv_of * ((axes[i] - axes[dominant] * (along[i] * per)) * weights),
        uv_of * ((axes[j] - axes[dominant] * (along[j] * per)) * weights));

    Material m = materials.materials[d.material];
    Place here = Place(mat3x4(v[0].uv, v[1].uv, v[2].uv) * b, vec4(1.0));
    if (isColored(m)) here.color = mat3x4(v[0].color, v[1].color, v[2].color) * b;
    vec4 base = baseColor(m, here, g);
    bool even = (!WARPED || CURVED) && map.curved == 0;
    // Where coverage masks are exact, the merge cuts out holes instead.
    if (base.a < (even ? min(m.alpha_cutoff, 0.01) : m.alpha_cutoff)) return;
    vec3 n = mat3(normalize(normalToWorld(d.instance, v[0].normal)),
        normalize(normalToWorld(d.instance, v[1].normal)),
        normalize(normalToWorld(d.instance, v[2].normal))) * b;
    // Face normal, oriented like the vertex normals. Mean vertex normals fit no plane, and a small ball would
    // be a quarter too bright.
    if (area > 0.0) n = face * (dot(face, n) < 0.0 ? -1.0 : 1.0);
    n = dot(n, n) > 0.0 ? normalize(n) : vec3(0.0);
    // Offset of the plane from the cell centre, along the axis that the surface faces.
    uint axis = axisOf(n);
    vec3 passes = vec3(cell) + 0.5;
    float slope = along[axis];
    passes[axis] += clamp(dot(face, a - middle) / (abs(slope) > 1e-30 ? slope : 1e-30), -0.5, 0.5);
    storeVoxel(cell, p.cascade, reflectanceOf(m, base.rgb, here, g), n, emission(m, here, g), passes,
        even ? t : NO_TRIANGLE);
}

void storeCells(VolumeMap map, VoxelPiece p, CellRange r) {
    for (int z = r.from.z; z <= r.to.z; z++)
        for (int y = r.from.y; y <= r.to.y; y++)
            for (int x = r.from.x; x <= r.to.x; x++)
                if (touches(map, p, ivec3(x, y, z), ivec3(1), 0.0)) storeCell(map, p, ivec3(x, y, z));
}

#endif
