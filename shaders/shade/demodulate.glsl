// Specular light is divided by the lobe's reflectance, filtered, and multiplied by each pixel's own
// reflectance again. Reflectance grows towards grazing angles and must not be blurred.
#include "shade/lobe_albedo.glsl"

const float MIN_REFLECTANCE = 1e-3;
