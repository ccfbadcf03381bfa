#version 460
#extension GL_GOOGLE_include_directive : require
// Merges the fragments into their voxels (thesis, Section 4.1.1, last paragraphs) under one of several rules: modules/merge.
#include "params.glsl"
#include "common/volume.glsl"
#include "common/bricks.glsl"
#include "common/surfels.glsl"
#include "common/scene.glsl"
#include "common/materials.glsl"
#include "voxelize/parts.glsl"

layout(local_size_x = 128) in;

layout(std430) readonly buffer Indices { uint indices[]; } indices;

// Neighbours in the list mostly hit the same voxel: neighbouring threads take fragments that lie far apart, so that
// their atomics do not queue.
const uint SHARES = 1u << 16;

#include "modules/merge.glsl"

// Notes what lies outermost in each quarter. Mostly one surface is first and last, and the loop runs once.
void noteOutermost(uint word, uint side, Covered covered) {
    uint mine = 0;
    for (uint i = 0; i < 4; i++) {
        uvec2 quarter = quarterOf(covered.parts, i);
        int count = bitCount(quarter.x) + bitCount(quarter.y);
        if (count > 0) mine |= packOutermost(covered.offset, side, count) << 8 * i;
    }
    uint found = surfelData(word);
    for (;;) {
        uint seen = atomicCompSwap(surfels.quads[word >> 2][word & 3u], found, outerOf(found, mine));
        if (seen == found) return;
        found = seen;
    }
}

void merge(uint base, vec3 color, vec3 normal, float offset, uint emission, uint weight) {
    mergeInto(base, color, normal, weight);
    atomicAdd(surfelSums.words[base + SIDE_OFFSET], storedOffset(offset) * weight);
    atomicAdd(surfelSums.words[base + 3], weight);
    if (emission != 0) {
        uvec3 e = uvec3(min(unpackRadiance(emission), EMISSION_MAX) * EMISSION_SCALE * float(weight) + 0.5);
        for (uint i = 0; i < 3; i++) atomicAdd(surfelSums.words[base + 7 + i], e[i]);
    }
}

// The triangle's corners in cells of a cascade.
vec3 cornerOf(VolumeMap map, uvec2 triangle, uint i) {
    vec3 p = toWorld(draws.draws[triangle.x].instance, loadPosition(indices.indices[triangle.y + i]));
    return worldToVolume(map, p) * float(params.voxel_dim);
}

// Of a surface with holes, cuts out the parts of a cell whose middle lies in one; of what covers no part's middle its own counts. Corners in
// cells. No weight is left where nothing is.
void cutOut(uvec2 triangle, vec3 corner[3], ivec3 cell, uint axis, inout Covered covered) {
    Material m = materials.materials[draws.draws[triangle.x].material];
    if (m.alpha_cutoff <= 0.0) return;
    VertexAttributes v[3];
    vec2 p[3];
    for (int i = 0; i < 3; i++) {
        v[i] = loadAttributes(indices.indices[triangle.y + i]);
        p[i] = 8.0 * besideOf(corner[i] - vec3(cell), axis);
    }
    mat2 across = mat2(p[1] - p[0], p[2] - p[0]);
    if (abs(determinant(across)) < 1e-6) return;
    // Change of texture coordinates and vertex alpha from part to part.
    mat2x4 step = mat2x4(v[1].uv - v[0].uv, v[2].uv - v[0].uv) * inverse(across);
    vec2 alpha_step = vec2(v[1].color.a - v[0].color.a, v[2].color.a - v[0].color.a) * inverse(across);
    Gradient g = Gradient(step[0], step[1]);
    Place middle = Place((v[0].uv + v[1].uv + v[2].uv) / 3.0, vec4((v[0].color.a + v[1].color.a + v[2].color.a) / 3.0));
    uint before = bitCount(covered.parts.x) + bitCount(covered.parts.y);
    if (before == 0 && baseColor(m, middle, g).a < m.alpha_cutoff) covered.weight = 0;
    for (int word = 0; word < 2; word++) {
        for (uint left = covered.parts[word]; left != 0; left &= left - 1) {
            int bit = findLSB(left);
            vec2 at = vec2(bit & 7, 4 * word + (bit >> 3)) + 0.5;
            Place part = Place(v[0].uv + step * (at - p[0]), vec4(v[0].color.a + dot(alpha_step, at - p[0])));
            if (baseColor(m, part, g).a < m.alpha_cutoff) covered.parts[word] &= ~(1u << bit);
        }
    }
    uint kept = bitCount(covered.parts.x) + bitCount(covered.parts.y);
    if (before > 0) covered.weight = kept > 0 ? max(covered.weight * kept / before, 1u) : 0;
}

// Which parts of a stored cell the triangle of a fragment covers, and where. Here and not where fragments are made: all of the
// chip helps.
Covered coveredBy(uvec2 triangle, ivec3 stored, uint axis, float offset) {
    if (triangle == NO_TRIANGLE) return wholeCell(offset);
    VolumeMap map = volume.maps[cascadeOf(stored)];
    ivec3 cell = ivec3(cellCentre(stored) * float(params.voxel_dim));
    vec3 corner[3] = vec3[3](cornerOf(map, triangle, 0), cornerOf(map, triangle, 1), cornerOf(map, triangle, 2));
    Covered covered = coveredParts(corner[0], corner[1], corner[2], cell, axis, offset);
    cutOut(triangle, corner, cell, axis, covered);
    return covered;
}

void main() {
    uint count = min(voxelCounter.fragments, voxelFragments.list.length());
    uint share = (count + SHARES - 1) / SHARES;
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint t = gl_GlobalInvocationID.x; t < share * SHARES; t += stride) {
        uint i = t % SHARES * share + t / SHARES;
        if (i >= count) continue;
        uvec4 fragment = voxelFragments.list[i];
        ivec3 stored = unpackCell(fragment.x);
        uint found = foundAtStored(stored);
        vec3 normal = unpackDirection(fragment.z);
        uint axis = axisOf(normal);
        if (found == 0) {
            atomicAdd(voxelCounter.overflow, 1);
            continue;
        }
        uvec2 triangle = voxelTriangles.list[i];
        Covered covered = coveredBy(triangle, stored, axis, unpackOffset(fragment.z));
        if (covered.weight == 0) continue;
        uint side = sideOf(normal, axis), surfel = surfelOf(found, axis), plane = surfelBase(surfel);
        merge(sideBase(surfel, side), unpackColor(fragment.y), normal, covered.offset, fragment.w, covered.weight);
        if (SIDES == 1) continue; // only sides have planes
        // Of points and samples nobody knows where their plane passes the cell's middle.
        if (triangle != NO_TRIANGLE) noteOutermost(outermostWord(plane, side), side, covered);
        for (uint k = 0; k < 2; k++) {
            uint word = partsWord(plane, side) + k;
            if ((surfelData(word) & covered.parts[k]) != covered.parts[k]) atomicOr(surfels.quads[word >> 2][word & 3u], covered.parts[k]);
        }
    }
}
