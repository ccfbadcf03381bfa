// One surfel per cell, whatever direction its surfaces face.
const uint SIDES = 1;

uint axisOf(vec3 normal) {
    return 0;
}

uint sideOf(vec3 normal, uint axis) {
    return 0;
}
