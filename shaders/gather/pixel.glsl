// Images of the light gathered for each pixel, before filtering and shading.
#include "gbuffer/read.glsl"
#include "modules/trace.glsl"

uniform writeonly image2D gatheredDiffuse; // mean radiance over the hemisphere; a: openness
// Radiance towards the viewer; a: age [frames].
#ifdef READS_AGE
layout(rgba16f) uniform image2D gatheredSpecular;
#else
uniform writeonly image2D gatheredSpecular;
#endif

const Gathered NOTHING_GATHERED = Gathered(vec4(0.0, 0.0, 0.0, 1.0), vec3(0.0));
