// Light times the cone's openness, which darkens a second time (thesis, Algorithm 3); there is no sky.
vec3 coneRadiance(vec4 cone, vec3 d, float spread) {
    return cone.rgb * (1.0 - cone.a);
}
