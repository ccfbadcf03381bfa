// Cells of one size.
const bool WARPED = false;

#include "common/unwarped.glsl"
#include "common/boxes.glsl"
