// Looks up from off the surface: with less than a whole texel surfaces shadow themselves, with one light enters where they
// meet.
float lightVisibility(Light light, vec3 p, vec3 n, vec3 to_light) {
    if (light.shadow_view < 0) return 1.0;
    int layer = shadowLayerOf(light, p);
    vec3 q = shadowPosition(layer, offSurface(p, n, to_light, params.shadow_bias * shadowTexel(layer, light, p)));
    return shadowTaps(layer, q, vec2(0.0));
}
