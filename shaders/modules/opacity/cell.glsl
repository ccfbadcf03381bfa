// One layer per cell of the level, corrected for the step length only: thin walls leak.
float stepAlpha(float a, float remaining, float advance, float voxel, float cell) {
    return remaining * (1.0 - pow(1.0 - min(a, 1.0), advance / cell));
}

vec3 directionWeights(vec3 dir) {
    return dir * dir;
}

float opacityScale(float a, float voxel, float cell, float other_voxel, float other_cell) {
    return 1.0;
}
