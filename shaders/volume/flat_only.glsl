// Stubs of the tests in curved coordinates, for warps whose triangles have flat ones.
void curvedBounds(VolumeMap map, vec3 a, vec3 b, vec3 c, out vec3 low, out vec3 high) {
    low = high = vec3(0.0);
}

bool curvedTouches(VolumeMap map, vec3 a, vec3 b, vec3 c, vec3 low, vec3 high) {
    return false;
}

vec2 curvedDepths(VolumeMap map, vec3 a, vec3 b, vec3 c, vec2 low, vec2 high) {
    return vec2(0.0);
}
