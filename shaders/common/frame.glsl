#ifndef FRAME_GLSL
#define FRAME_GLSL

// A tangent frame of n (Duff et al. 2017).
mat3 frameOf(vec3 n) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    return mat3(1.0 + s * n.x * n.x * a, s * b, -s * n.x, b, s + n.y * n.y * a, -n.y, n);
}

#endif
