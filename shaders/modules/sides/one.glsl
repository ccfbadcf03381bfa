// All surfaces of a cell are one, whichever way they face.
const uint SIDES = 1;

uint axisOf(vec3 normal) {
    return 0;
}

uint sideOf(vec3 normal, uint axis) {
    return 0;
}
