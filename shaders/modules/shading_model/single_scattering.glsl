// The BRDF of glTF 2.0 without light that scatters more than once between facets: rough metals are darker, by up to half.
#define SINGLE_SCATTERING
#include "modules/shading_model/gltf.glsl"
