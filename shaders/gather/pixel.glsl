// Images of the light gathered for each pixel, before filtering and shading.
#include "gbuffer/read.glsl"
#include "modules/trace.glsl"

// gatheredDiffuse: mean radiance over the hemisphere; a: openness. gatheredSpecular: radiance towards the
// viewer; a: age and rounds, see history/rounds.glsl.
#ifdef READS_HISTORY
layout(rgba16f) uniform image2D gatheredDiffuse;
layout(rgba16f) uniform image2D gatheredSpecular;
#else
uniform writeonly image2D gatheredDiffuse;
uniform writeonly image2D gatheredSpecular;
#endif

const Gathered NOTHING_GATHERED = Gathered(vec4(0.0, 0.0, 0.0, 1.0), vec3(0.0));
