// Specular light is filtered without the lobe's reflectance, which grows towards the rim of what is round, and multiplied
// by each pixel's own afterwards.
#include "common/lobe_albedo.glsl"

const float MIN_REFLECTANCE = 1e-3;
