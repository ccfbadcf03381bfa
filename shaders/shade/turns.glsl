// Which of the pixels of 8x8 gather in a frame. A pixel gathers in its turn with the rays of all turns: a still picture has so many
// times the rays for the same price, and settles to the bit.
#include "common/scene.glsl"
#include "common/pattern.glsl"

// As old as what a pixel keeps would be if it had gathered in its turn, by its number in the block [frames]: as many as there are turns
// where it is due.
float ageInTurn(uint number) {
    uint turns = uint(params.turns), turn = number * turns / 64u;
    return float(turns - (turn + turns - camera.frame % turns) % turns);
}
