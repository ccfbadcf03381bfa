// Depth comparison in the shader, for one texel or four blended ones. Works for rasterised and computed maps.
// Everything outside the map is lit.
uniform sampler2DArray shadowDepths;

float shadowDepth(int layer, vec2 at) {
    return textureLod(shadowDepths, shadowPlace(layer, at, 0.5), 0.0).r;
}

float shadowLit(int layer, vec3 at) {
    return at.z <= shadowDepth(layer, at.xy) ? 1.0 : 0.0;
}

// Depths of the four texels around a position, in the order of textureGather: (0, 1), (1, 1), (1, 0), (0, 0).
vec4 shadowDepthsAround(int layer, vec2 at) {
    return textureGather(shadowDepths, shadowPlace(layer, at, 1.0));
}

float shadowBlended(int layer, vec3 at) {
    vec4 lit = vec4(lessThanEqual(vec4(at.z), shadowDepthsAround(layer, at.xy)));
    vec2 between = fract(at.xy * shadowEdge(layer) - 0.5);
    vec2 columns = mix(lit.wx, lit.zy, between.x); // upper, lower row
    return mix(columns.x, columns.y, between.y);
}
