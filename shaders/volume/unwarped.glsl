// Identity warp, for volumes without one.

vec3 warp(vec3 x) {
    return x;
}

vec3 warpSlope(vec3 x) {
    return vec3(1.0);
}

vec3 unwarp(vec3 y) {
    return y;
}
