// A surfel reflects diffusely the sum of its surfaces' diffuse albedo and the spherical albedo of their
// specular lobe.
#include "common/brdf.glsl"

vec3 reflectanceOf(Material m, vec3 base, Interpolants at, Gradient g) {
    vec2 rm = roughnessMetallic(m, at, g);
    Surface s = bareSurface(vec3(0.0), base, rm.x, rm.y, dielectric(m));
    return sphericalAlbedo(s.albedo, s.f0, s.f90, rm.x);
}
