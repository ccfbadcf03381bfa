// Which of the pixels of 8x8 gather in a frame. A pixel gathers in its turn with the rays of all turns: a still picture has so many
// times the rays for the same price, and settles to the bit. Pixels of the lattice gather for those around: they have the lowest
// numbers. The others do so for themselves alone, where they must.
#include "common/scene.glsl"
#include "common/pattern.glsl"

bool isOfLattice(uint number) {
    return number < uint(params.ray_patterns);
}

// As old as what a pixel keeps would be if it had gathered in its turn, by its number in the block [frames]: as many as there are turns
// where it is due.
float ageInTurn(uint number) {
    uint turns = uint(params.turns), turn = number * turns / (isOfLattice(number) ? uint(params.ray_patterns) : 64u);
    return float(turns - (turn + turns - camera.frame % turns) % turns);
}
