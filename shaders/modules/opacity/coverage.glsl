// Surfaces one voxel thick that fill this share of the volume cover this much of the cone, side by side. Thin walls stay
// closed at every level; corners darken a little too much.
#include "modules/mips.glsl"

// Opacity that a step adds to a cone of which `remaining` is left. `a`: of the texel; `advance` of the step, length of a
// level-0 cell and of a cell of the level along the cone [m].
float stepAlpha(float a, float remaining, float advance, float voxel, float cell) {
    return min(a * advance / opacityLength(voxel, cell), remaining);
}

// Weights of the three directions' texels that a ray along dir crosses: crossings are added up.
vec3 directionWeights(vec3 dir) {
    return abs(dir);
}

// Factor that tells a texel of another cascade (cells `other_voxel`, `other_cell`) as if it were of this one: opacity is a
// density.
float opacityScale(float a, float voxel, float cell, float other_voxel, float other_cell) {
    return opacityLength(voxel, cell) / opacityLength(other_voxel, other_cell);
}
