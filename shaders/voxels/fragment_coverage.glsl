// Coverage of a cell by the triangle of a fragment, without the holes of alpha masks.
#ifndef FRAGMENT_COVERAGE_GLSL
#define FRAGMENT_COVERAGE_GLSL
#include "common/scene.glsl"
#include "materials/materials.glsl"
#include "volume/volume.glsl"
#include "voxels/voxels.glsl"
#include "surfels/cover.glsl"

layout(std430) readonly buffer Indices { uint indices[]; } indices;

// Corner i of a triangle in cells of a cascade.
vec3 cornerOf(VolumeMap map, uvec2 triangle, uint i) {
    vec3 p = toWorld(draws.draws[triangle.x].instance, loadPosition(indices.indices[triangle.y + i]));
    return worldToVolume(map, p) * float(params.voxel_dim);
}

// Clears the mask texels with their centre in a hole of an alpha mask. If the mask is empty, the triangle's
// centroid decides. Corners in cells. The weight becomes 0 if nothing is left.
void cutOut(uvec2 triangle, vec3 corner[3], ivec3 cell, uint axis, inout Coverage coverage) {
    Material m = materials.materials[draws.draws[triangle.x].material];
    if (m.alpha_cutoff <= 0.0) return;
    VertexAttributes v[3];
    vec2 p[3];
    for (int i = 0; i < 3; i++) {
        v[i] = loadAttributes(indices.indices[triangle.y + i]);
        p[i] = 8.0 * lateralOf(corner[i] - vec3(cell), axis);
    }
    mat2 across = mat2(p[1] - p[0], p[2] - p[0]);
    if (abs(determinant(across)) < 1e-6) return;
    // Gradients of texture coordinates and vertex alpha per mask texel.
    mat2x4 step = mat2x4(v[1].uv - v[0].uv, v[2].uv - v[0].uv) * inverse(across);
    vec2 alpha_step = vec2(v[1].color.a - v[0].color.a, v[2].color.a - v[0].color.a) * inverse(across);
    Gradient g = Gradient(step[0], step[1]);
    Interpolants middle = Interpolants((v[0].uv + v[1].uv + v[2].uv) / 3.0,
        vec4((v[0].color.a + v[1].color.a + v[2].color.a) / 3.0));
    uint before = coveredTexels(coverage.mask);
    if (before == 0 && baseColor(m, middle, g).a < m.alpha_cutoff) coverage.weight = 0;
    for (int word = 0; word < 2; word++) {
        for (uint left = coverage.mask[word]; left != 0; left &= left - 1) {
            int bit = findLSB(left);
            vec2 at = vec2(bit & 7, 4 * word + (bit >> 3)) + 0.5;
            float alpha = v[0].color.a + dot(alpha_step, at - p[0]);
            Interpolants part = Interpolants(v[0].uv + step * (at - p[0]), vec4(alpha));
            if (baseColor(m, part, g).a < m.alpha_cutoff) coverage.mask[word] &= ~(1u << bit);
        }
    }
    uint after = coveredTexels(coverage.mask);
    if (before > 0) coverage.weight = after > 0 ? max(coverage.weight * after / before, 1u) : 0;
}

// Coverage of a stored cell by a fragment's triangle. Computed here instead of at fragment creation, so that
// the whole GPU takes part.
Coverage fragmentCoverage(uvec2 triangle, ivec3 stored, uint axis, float offset) {
    if (triangle == NO_TRIANGLE) return fullCoverage(offset);
    VolumeMap map = volume.maps[cascadeOf(stored)];
    ivec3 cell = ivec3(cellCentre(stored) * float(params.voxel_dim));
    vec3 corner[3] = vec3[3](cornerOf(map, triangle, 0), cornerOf(map, triangle, 1),
        cornerOf(map, triangle, 2));
    Coverage coverage = triangleCoverage(corner[0], corner[1], corner[2], cell, axis, offset);
    cutOut(triangle, corner, cell, axis, coverage);
    return coverage;
}

#endif
