// Khronos PBR Neutral, with the symbols of its specification (KhronosGroup/ToneMapping, PBR_Neutral).
// Base colours up to 0.8 under white light of irradiance pi keep hue and saturation.
vec3 toneMap(vec3 c) {
    const float F90 = 0.04; // Fresnel reflection of common dielectrics, subtracted
    const float K_S = 0.8 - F90; // start of the compression
    const float K_D = 0.15; // speed of the desaturation
    float x = min(c.r, min(c.g, c.b));
    float f = x > 2.0 * F90 ? F90 : x - x * x / (4.0 * F90);
    c -= f;
    float p = max(c.r, max(c.g, c.b));
    if (p <= K_S) return c;
    float p_n = 1.0 - (1.0 - K_S) * (1.0 - K_S) / (p + 1.0 - 2.0 * K_S);
    float g = 1.0 / (K_D * (p - p_n) + 1.0);
    return mix(vec3(p_n), c * (p_n / p), g);
}
