// Six surfels per cell: three axes with two sides each. A wall thinner than a voxel is lit on one side and
// dark on the other, and a floor keeps its light separate from an adjoining wall.
#include "common/math.glsl"

const uint SIDES = 2;

uint axisOf(vec3 normal) {
    return dominantAxis(normal);
}

// 0: along the axis, 1: against it.
uint sideOf(vec3 normal, uint axis) {
    return normal[axis] < 0.0 ? 1u : 0u;
}
