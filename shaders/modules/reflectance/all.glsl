// A voxel reflects, in all directions alike, as much as its surfaces do: the diffuse albedo, and of the specular lobe the share
// of light from all around that it reflects.
#include "common/brdf.glsl"

vec3 reflectanceOf(Material m, vec3 base, Place at, Gradient g) {
    vec2 rm = roughnessMetallic(m, at, g);
    Surface s = bareSurface(vec3(0.0), base, rm.x, rm.y, dielectric(m));
    return sphericalAlbedo(s.albedo, s.f0, s.f90, rm.x);
}
