// Alpha mask of a depth-only pass. The including file defines MASK_FOOTPRINT: see modules/pixel.glsl.
#include "materials/materials.glsl"

layout(location = 0) in vec4 uv;
layout(location = 1) flat in uint material;
layout(location = 2) in float alpha;

void main() {
    Material m = materials.materials[material];
    Gradient g = Gradient(MASK_FOOTPRINT * dFdx(uv), MASK_FOOTPRINT * dFdy(uv));
    if (baseColor(m, Interpolants(uv, vec4(alpha)), g).a < m.alpha_cutoff) discard;
}
