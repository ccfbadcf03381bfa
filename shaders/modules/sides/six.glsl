// The surfaces of a cell by the way they face: those that face along x, y and z are apart, and of each the two sides. A wall
// thinner than a voxel is lit on one side and dark on the other, and a floor keeps its light to itself where it meets a wall.
#include "common/math.glsl"

const uint SIDES = 2;

uint axisOf(vec3 normal) {
    return dominantAxis(normal);
}

// 0: along the axis, 1: against it.
uint sideOf(vec3 normal, uint axis) {
    return normal[axis] < 0.0 ? 1u : 0u;
}
