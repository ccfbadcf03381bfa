// Reinhard's curve for each channel (thesis, Algorithm 3). Never reaches 1.
vec3 toneMap(vec3 c) {
    return c / (c + 1.0);
}
