// The BRDF of glTF 2.0 without multiple scattering between facets: rough metals are darker, by up to half.
#define SINGLE_SCATTERING
#include "modules/shading_model/gltf.glsl"
