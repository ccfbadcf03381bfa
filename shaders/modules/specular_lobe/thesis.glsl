// A cone in the mirror direction with an aperture of 0.1 pi roughness, weighted only by f90: every surface is
// shiny unless its author dims it (thesis, Section 4.5.2).
vec3 specularDirection(Surface s, vec3 v) {
    return reflect(-v, s.normal);
}

float specularHalfAngle(Surface s) {
    return 0.05 * PI * s.roughness;
}

vec3 specularWeight(Surface s, vec3 v) {
    return vec3(s.f90);
}
