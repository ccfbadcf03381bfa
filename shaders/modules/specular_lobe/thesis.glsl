// A cone in the mirror direction, 0.1 pi roughness wide, added as it is: everything shines (thesis, Section 4.5.2) that its
// author has not told to shine less.
vec3 specularDirection(Surface s, vec3 v) {
    return reflect(-v, s.normal);
}

float specularHalfAngle(Surface s) {
    return 0.05 * PI * s.roughness;
}

vec3 specularWeight(Surface s, vec3 v) {
    return vec3(s.f90);
}
