// Which of the pixels of 8x8 gather in a frame. A pixel gathers in its turn with the rays of all turns: a still picture has so many
// times the rays for the same price, and settles to the bit.
#include "common/scene.glsl"
#include "common/pattern.glsl"

// By a pixel's number in its block.
bool isDue(uint number) {
    uint turns = uint(params.turns);
    return number * turns / 64u == camera.frame % turns;
}

// The lowest number that is due.
uint firstDue() {
    uint turns = uint(params.turns);
    return (camera.frame % turns * 64u + turns - 1u) / turns;
}
