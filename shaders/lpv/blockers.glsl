// Adds a piece of surface to the blockers of all grids. source: 0, seen by lights; 1, by the camera.
#include "lpv/grid.glsl"

layout(std430) buffer LpvBlockers { int coefficients[]; } lpvBlockers;

// area [m^2] of the piece. Its chance to block light is its area seen along the light, as a share of a
// cell's face.
void addBlocker(vec3 p, vec3 n, float area, int source) {
    for (int grid = 0; grid < params.lpv_cascades; grid++) {
        float cell = cellEdge(grid);
        ivec3 corner = ivec3(round((p - gridCorner(grid)) / cell));
        if (any(greaterThan(uvec3(corner), uvec3(params.lpv_dim)))) continue;
        ivec4 add = ivec4(round(cosineLobe(n) * min(area / (cell * cell), 64.0) * BLOCKER_UNIT));
        uint first = 8u * indexIn(params.lpv_dim + 1, corner, grid) + 4u * uint(source);
        for (int i = 0; i < 4; i++)
            if (add[i] != 0) atomicAdd(lpvBlockers.coefficients[first + i], add[i]);
    }
}
