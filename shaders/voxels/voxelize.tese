#version 460
#extension GL_GOOGLE_include_directive : require
// Stores one point per tessellated vertex, without rasterisation (thesis, Section 4.1.2).
#include "params.glsl"
#include "materials/materials.glsl"
#include "modules/reflectance.glsl"
#include "volume/volume.glsl"
#include "voxels/tessellated.glsl"
#include "voxels/store.glsl"
#include "common/random.glsl"

layout(triangles, equal_spacing, point_mode) in;

layout(location = 0) in vec3 position[];
layout(location = 1) in vec3 normal[];
layout(location = 2) in vec4 uv[];
layout(location = 3) patch in uint material;
layout(location = 4) patch in vec2 footprint;
layout(location = 5) patch in uint single;
layout(location = 6) patch in float spacing;
layout(location = 7) in vec4 color[];

// The densest cells of a patch set its point count, which is far too high for other cells and coarser
// cascades. A hash of the position thins the points to about this many per crossed cell (one cell in 3,000
// gets none).
const float POINTS_A_CELL = 8.0;

bool chosen(VolumeMap g, vec3 p) {
    if (CASCADE_COUNT == 1 && !CURVED) return true;
    vec3 size = cellSize(g, p);
    float cell = min(size.x, min(size.y, size.z));
    float share = POINTS_A_CELL * spacing * spacing / (cell * cell);
    if (share >= 1.0) return true;
    Random random = Random(uvec4(floatBitsToUint(p), 0u));
    return next4(random).x < share;
}

void main() {
    gl_Position = vec4(0.0);
    vec3 b = gl_TessCoord;
    if (single != 0) { // one point for the whole triangle, from one of its three vertices
        if (b.x < 0.5) return;
        b = vec3(1.0 / 3.0);
    }
    vec3 p = mat3(position[0], position[1], position[2]) * b;
    Interpolants at = Interpolants(mat3x4(uv[0], uv[1], uv[2]) * b, mat3x4(color[0], color[1], color[2]) * b);
    vec2 across = footprint;
    Gradient g = Gradient(vec4(across.x, 0.0, across.y, 0.0), vec4(0.0, across.x, 0.0, across.y));
    Material m = materials.materials[material];
    vec4 base = baseColor(m, at, g);
    if (base.a < m.alpha_cutoff) return;
    vec3 n = mat3(normal[0], normal[1], normal[2]) * b;
    n = dot(n, n) > 0.0 ? normalize(n) : n;
    vec3 reflected = reflectanceOf(m, base.rgb, at, g), light = emission(m, at, g);
    for (int k = 0; k < tessellatedCascades(); k++) {
        vec3 in_cells = worldToVolume(volume.maps[k], p) * float(params.voxel_dim);
        ivec3 cell = ivec3(floor(in_cells));
        if (inGrid(cell) && (single != 0 || chosen(volume.maps[k], p)))
            storeVoxel(cell, k, reflected, n, light, in_cells, NO_TRIANGLE);
    }
}
