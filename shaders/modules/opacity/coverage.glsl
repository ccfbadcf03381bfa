// Opacities of successive steps add up, instead of multiplying transmittances, until the cone is full. A step
// adds the texel's opacity times the step's length in cells of the level (anisotropic mips) or voxels
// (isotropic). Thin walls stay closed at every level; corners darken slightly too much.
#include "modules/mips.glsl"

// Opacity that a step adds to a cone with transmittance `remaining`. a: of the texel. advance: of the step.
// voxel, cell: length of a cell of level 0 and of the sampled level along the cone [m].
float stepAlpha(float a, float remaining, float advance, float voxel, float cell) {
    return min(a * advance / opacityLength(voxel, cell), remaining);
}

// Weights of the three directional texels along dir: the crossings along each axis add up, so the sum may
// exceed 1. stepAlpha clamps.
vec3 directionWeights(vec3 dir) {
    return abs(dir);
}

// Factor that converts a texel of another cascade (cells `other_voxel`, `other_cell`) to this one: opacity is
// a density.
float opacityScale(float a, float voxel, float cell, float other_voxel, float other_cell) {
    return opacityLength(voxel, cell) / opacityLength(other_voxel, other_cell);
}
