#version 460
#extension GL_GOOGLE_include_directive : require
// Stores a fragment as a voxel (base colour: metals reflect about as much, only not diffusely). Modes that over-cover (hardware, dilate) also store the column's other
// cells that the triangle passes through, and test each.
#include "params.glsl"
#include "materials.glsl"
#include "voxel_raster.glsl"
#include "overlap.glsl"
#include "store_voxel.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) flat in uint material;
layout(location = 4) flat in uint axis;
layout(location = 5) flat in vec3 corner[3];

// Whether the triangle overlaps a cell, exactly wherever cells are boxes: in the coordinates of the cell itself.
bool overlapsCell(ivec3 cell) {
    if (WARP == WARP_NONE) return triangleOverlapsCell(corner[0], corner[1], corner[2], cell);
    if (WARP == WARP_PERSPECTIVE) return true;
    float dim = float(params.voxel_dim);
    vec3 low = unwarp(vec3(cell) / dim), size = unwarp(vec3(cell + 1) / dim) - low;
    vec3 c[3];
    for (int i = 0; i < 3; i++) {
        vec3 u = corner[i] / dim; // not warped outside the volume
        c[i] = (mix(u, unwarp(clamp(u, 0.0, 1.0)), equal(clamp(u, 0.0, 1.0), u)) - low) / size;
    }
    return triangleOverlapsCell(c[0], c[1], c[2], ivec3(0));
}

void main() {
    float dim = float(params.voxel_dim);
    vec3 at = worldToVolume(volume.grid, position) * dim;
    vec3 across = dFdx(at), down = dFdy(at);
    // Texture footprint of a cell, not of a pixel: warps draw several pixels a cell.
    float pixels = 1.0 / clamp(max(length(across), length(down)), 1.0 / 64.0, 1.0);
    Gradient g = Gradient(dFdx(uv) * pixels, dFdy(uv) * pixels);

    Material m = materials.materials[material];
    vec4 base = baseColor(m, uv, g);
    if (base.a < m.alpha_cutoff) return;
    vec3 n = dot(normal, normal) > 0.0 ? normalize(normal) : vec3(0.0);
    vec3 light = emission(m, uv, g);

    // With several samples the centre may lie outside the triangle: back into its box.
    vec3 lo = min(corner[0], min(corner[1], corner[2])), hi = max(corner[0], max(corner[1], corner[2]));
    vec3 inside = clamp(at, lo, hi);
    ivec3 cell = ivec3(floor(inside));
    if (CONSERVATIVE != CONSERVATIVE_HARDWARE && CONSERVATIVE != CONSERVATIVE_DILATE) {
        if (inGrid(cell)) storeVoxel(cell, base.rgb, n, light);
        return;
    }

    int depth = int(axis & 3u);
    ivec3 axes = planeAxes(axis & 3u);
    // Attributes of fragments beside their triangle are extrapolated, and of thin triangles no more than noise: without
    // a warp the column is the pixel, and the depth that of the corners' plane.
    ivec3 column = ivec3(floor(inside));
    float middle = at[depth], reach = 0.5 * (abs(across[depth]) + abs(down[depth])) + 1e-4;
    if (WARP == WARP_NONE) {
        vec3 face = cross(corner[1] - corner[0], corner[2] - corner[0]);
        vec2 slope = face[depth] != 0.0 ? -vec2(face[axes.x], face[axes.y]) / face[depth] : vec2(dim); // a line: any depth
        vec2 pixel = floor(gl_FragCoord.xy) + 0.5;
        column[axes.x] = int(gl_FragCoord.x);
        column[axes.y] = int(gl_FragCoord.y);
        middle = corner[0][depth] + dot(slope, pixel - vec2(corner[0][axes.x], corner[0][axes.y]));
        reach = 0.5 * (abs(slope.x) + abs(slope.y)) + 1e-2;
    }
    float first = clamp(middle - reach, lo[depth], hi[depth]);
    float last = clamp(middle + reach, lo[depth], hi[depth]);
    if ((axis & SLIVER) != 0) {
        first = lo[depth];
        last = hi[depth];
    }
    // A corner exactly on a border belongs to both cells.
    for (int z = max(int(floor(first - 1e-5)), 0); z <= min(int(floor(last + 1e-5)), params.voxel_dim - 1); z++) {
        cell = column;
        cell[depth] = z;
        if (!inGrid(cell)) continue;
        if (!overlapsCell(cell)) continue;
        storeVoxel(cell, base.rgb, n, light);
    }
}
