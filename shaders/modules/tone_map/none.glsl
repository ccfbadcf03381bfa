// Linear up to 1, then clamped.
vec3 toneMap(vec3 c) {
    return clamp(c, 0.0, 1.0);
}
