// A surfel reflects its base colour. Metals reflect about as much, only not diffusely.
vec3 reflectanceOf(Material m, vec3 base, Interpolants at, Gradient g) {
    return base;
}
