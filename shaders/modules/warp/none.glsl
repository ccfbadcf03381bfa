// A uniform grid.
const bool WARPED = false;

#include "volume/unwarped.glsl"
#include "volume/boxes.glsl"
