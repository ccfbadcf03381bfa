// Which of the pixels of 8x8 gather in a frame. A pixel gathers in its turn with the rays of all turns: a still picture has so many
// times the rays for the same price, and settles to the bit. Pixels of the lattice gather for those around: they have the lowest
// numbers. The others do so for themselves alone, where they must.
#include "common/scene.glsl"
#include "common/pattern.glsl"

bool isOfLattice(uint number) {
    return number < uint(params.ray_patterns);
}

// By a pixel's number in its block.
bool isDue(uint number) {
    uint turns = uint(params.turns);
    return number * turns / (isOfLattice(number) ? uint(params.ray_patterns) : 64u) == camera.frame % turns;
}

// The lowest number of the lattice that is due.
uint firstDue() {
    uint turns = uint(params.turns);
    return (camera.frame % turns * uint(params.ray_patterns) + turns - 1u) / turns;
}
