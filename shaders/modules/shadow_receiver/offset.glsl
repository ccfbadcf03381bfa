// Looks up a position offset from the surface. An offset below a texel causes self-shadowing; a full texel
// leaks light where surfaces meet.
float lightVisibility(Light light, vec3 p, vec3 n, vec3 to_light) {
    if (light.shadow_view < 0) return 1.0;
    int layer = shadowLayerOf(light, p);
    vec3 q = shadowPosition(layer,
        offSurface(p, n, to_light, params.shadow_bias * shadowTexel(layer, light, p)));
    return shadowTaps(layer, q, vec2(0.0));
}
