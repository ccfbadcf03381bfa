// Directions that meet nothing in the picture are dark.
vec3 missedLight(GBufferSurface seen, vec3 d, float spread, inout float open) {
    return vec3(0.0);
}

vec3 emitterLight(GBufferSurface seen, uint number) {
    return vec3(0.0);
}
