// A voxel reflects its base colour: metals reflect about as much, only not diffusely.
vec3 reflectanceOf(Material m, vec3 base, Place at, Gradient g) {
    return base;
}
