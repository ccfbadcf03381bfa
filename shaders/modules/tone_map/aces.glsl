// Curve for each channel, fitted to the ACES filmic transform (Narkowicz 2015).
vec3 toneMap(vec3 c) {
    return clamp(c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14), 0.0, 1.0);
}
