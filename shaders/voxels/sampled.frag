#version 460
#extension GL_GOOGLE_include_directive : require
// Stores a fragment in the cell of its sample position.
#include "params.glsl"
#include "voxels/fragment.glsl"

void main() {
    int cascade = rasterCascade();
    vec3 at = worldToVolume(volume.maps[cascade], position) * float(params.voxel_dim);
    float pixels = footprintScale(at);
    Gradient g = Gradient(dFdx(uv) * pixels, dFdy(uv) * pixels);
    Material m = materials.materials[material];
    Interpolants here = Interpolants(uv, color);
    vec4 base = baseColor(m, here, g);
    if (base.a < m.alpha_cutoff) return;
    // With multisampling the pixel centre may be outside the triangle: clamp it to the bounding box.
    vec3 lo = min(corner[0], min(corner[1], corner[2])),
        hi = max(corner[0], max(corner[1], corner[2]));
    ivec3 cell = ivec3(floor(clamp(at, lo, hi)));
    vec3 n = dot(normal, normal) > 0.0 ? normalize(normal) : vec3(0.0);
    if (inGrid(cell))
        storeVoxel(cell, cascade, reflectanceOf(m, base.rgb, here, g), n, emission(m, here, g), at,
            NO_TRIANGLE);
}
