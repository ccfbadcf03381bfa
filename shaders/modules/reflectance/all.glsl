// A voxel reflects, in all directions alike, as much as its surfaces do: the diffuse albedo, and of the specular lobe the share
// of light from all around that it reflects. f0 a + f90 b, fitted to the BRDF of cook_torrance.glsl (GGX of alpha = roughness^2,
// Smith-Schlick) over roughness within 0.005: 1.7 % (rough) to 5.4 % (smooth) for f0 = 0.04.
vec3 reflectanceOf(Material m, vec3 base, vec2 uv, Gradient g) {
    vec2 rm = roughnessMetallic(m, uv, g);
    float r = clamp(rm.x, 0.0, 1.0);
    float a = 0.811 + r * (-0.027 + r * (-0.622 + r * 0.209)), b = 0.0235 + r * (-0.0294 + r * (-0.0061 + r * 0.0143));
    vec4 plain = dielectric(m);
    float f90 = plain.a + (1.0 - plain.a) * rm.y;
    return min(base * (1.0 - rm.y) + mix(plain.rgb, base, rm.y) * a + b * f90, 1.0);
}
