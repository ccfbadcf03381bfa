// Depth comparison by the sampler, which blends four texels if it filters.
uniform sampler2DArrayShadow shadowCompare;

float shadowLit(int layer, vec3 at) {
    return textureGrad(shadowCompare, vec4(at.xy, layer, at.z), vec2(0.0), vec2(0.0));
}
