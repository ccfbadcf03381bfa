// Nested grids of cells, and spherical harmonics of two bands: a constant, then x, y and z.
#ifndef LPV_GRID_GLSL
#define LPV_GRID_GLSL
#include "common/math.glsl"
#include "common/scene.glsl"

// Edge of a cell of a grid [m]. The first grid has a free cell around the scene.
float cellEdge(int grid) {
    vec3 extent = sceneInfo.bounds_max - sceneInfo.bounds_min;
    float edge = max(extent.x, max(extent.y, extent.z)) / float(params.lpv_dim - 2);
    return edge * exp2(-float(grid));
}

// Lowest corner of a grid [m]. All but the first are a quarter of their edge ahead of the camera, inside
// the first, and move in steps of their cells.
vec3 gridCorner(int grid) {
    float cell = cellEdge(grid), edge = cell * float(params.lpv_dim);
    vec3 whole = vec3(0.5 * cellEdge(0) * float(params.lpv_dim));
    vec3 middle = 0.5 * (sceneInfo.bounds_min + sceneInfo.bounds_max);
    if (grid == 0) return middle - whole;
    vec3 centre = camera.position + 0.25 * edge * camera.direction;
    centre = clamp(centre, middle - whole + 0.5 * edge, middle + whole - 0.5 * edge);
    return floor((centre - 0.5 * edge) / cell) * cell;
}

bool inGrid(ivec3 cell) {
    return all(lessThan(uvec3(cell), uvec3(params.lpv_dim)));
}

// Index in a buffer of grids with `edge` elements along an edge: lpv_dim cells, or one more corner.
uint indexIn(int edge, ivec3 at, int grid) {
    return uint(at.x + edge * (at.y + edge * (at.z + edge * grid)));
}

vec4 harmonics(vec3 d) {
    return vec4(0.2820948, 0.4886025 * d);
}

// The clamped cosine around n.
vec4 cosineLobe(vec3 n) {
    return vec4(0.8862269, 1.0233267 * n);
}

// Fixed-point numbers: integer sums are the same in any order.
const float LIGHT_UNIT = 65536.0, BLOCKER_UNIT = 65536.0;

#endif
