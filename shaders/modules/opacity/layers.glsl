// A mean opacity belongs to one voxel, and a step crosses advance / voxel of them, one behind the other. For
// isotropic levels.
float stepAlpha(float a, float remaining, float advance, float voxel, float cell) {
    return remaining * (1.0 - pow(1.0 - min(a, 1.0), advance / voxel));
}

vec3 directionWeights(vec3 dir) {
    return dir * dir;
}

float opacityScale(float a, float voxel, float cell, float other_voxel, float other_cell) {
    return a > 0.0 ? (1.0 - pow(1.0 - min(a, 1.0), voxel / other_voxel)) / a : 1.0;
}
