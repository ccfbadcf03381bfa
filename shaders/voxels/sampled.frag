#version 460
#extension GL_GOOGLE_include_directive : require
// Stores a fragment as a voxel in the cell that its sample
// lies in.
#include "params.glsl"
#include "voxels/fragment.glsl"

void main() {
    int cascade = rasterCascade();
    vec3 at = worldToVolume(volume.maps[cascade], position) * float(params.voxel_dim);
    float pixels = footprintScale(at);
    Gradient g = Gradient(dFdx(uv) * pixels, dFdy(uv) * pixels);
    Material m = materials.materials[material];
    Place here = Place(uv, color);
    vec4 base = baseColor(m, here, g);
    if (base.a < m.alpha_cutoff) return;
    // With several samples the centre may lie outside the triangle: back into its box.
    vec3 lo = min(corner[0], min(corner[1], corner[2])), hi = max(corner[0], max(corner[1], corner[2]));
    ivec3 cell = ivec3(floor(clamp(at, lo, hi)));
    vec3 n = dot(normal, normal) > 0.0 ? normalize(normal) : vec3(0.0);
    if (inGrid(cell)) storeVoxel(cell, cascade, reflectanceOf(m, base.rgb, here, g), n, emission(m, here, g), at, NO_TRIANGLE);
}
