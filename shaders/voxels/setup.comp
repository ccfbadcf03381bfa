#version 460
#extension GL_GOOGLE_include_directive : require
// Triangle setup, one thread per triangle and cascade: converts to flat coordinates, and clips at the near
// plane if the cells have one.
#include "params.glsl"
#include "voxels/pieces.glsl"

layout(local_size_x = 64) in;

void assign(VolumeMap map, VoxelPiece p) {
    CellRange r = rangeOf(map, p);
    ivec3 edge = r.to - r.from + 1;
    if (any(lessThanEqual(edge, ivec3(0)))) return;
    if (edge.x * edge.y * edge.z > SMALL_CELLS) {
        uint i = atomicAdd(voxelCounter.pieces, 1);
        if (i < voxelPieces.list.length()) {
            p.columns = uint(r.from.x + 1024) | uint(r.to.x + 1024) << 16;
            voxelPieces.list[i] = p;
            return;
        }
    }
    storeCells(map, p, r);
}

// Intersection of an edge with the near plane. `before`, `behind`: corners; `from`, `to`: their depths.
vec3 cutBetween(vec3 before, vec3 behind, float from, float to, float near) {
    return mix(before, behind, (from - near) / (from - to));
}

// Clips a triangle at the near plane of the cells, if they have one. Returns the number of triangles left, 0
// to 2.
int cutTriangle(VolumeMap map, vec3 p[3], out vec3 parts[6]) {
    uint before = 7;
    float near = map.range.x, w[3];
    for (int i = 0; i < 3; i++) {
        parts[i] = p[i];
        w[i] = flatDepth(map, p[i]);
        if (hasNear(map) && w[i] < near) before &= ~(1u << i);
    }
    if (before == 7) return 1;
    if (before == 0) return 0;
    bool one = bitCount(before) == 1;
    int odd = findLSB(one ? before : 7u & ~before), // the corner alone on its side of the plane
        k = (odd + 1) % 3, l = (odd + 2) % 3;
    vec3 to_k = cutBetween(p[odd], p[k], w[odd], w[k], near),
        to_l = cutBetween(p[odd], p[l], w[odd], w[l], near);
    if (one) {
        parts = vec3[6](p[odd], to_k, to_l, vec3(0.0), vec3(0.0), vec3(0.0));
        return 1;
    }
    parts = vec3[6](p[k], p[l], to_l, p[k], to_l, to_k);
    return 2;
}

void main() {
    int cascade = int(gl_GlobalInvocationID.y);
    VolumeMap map = volume.maps[cascade];
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint index = gl_GlobalInvocationID.x; index < sceneInfo.triangle_count; index += stride) {
        uvec2 t = triangles.list[index];
        uint instance = draws.draws[t.x].instance;
        vec3 p[3], parts[6];
        for (int i = 0; i < 3; i++) p[i] = toWorld(instance, loadPosition(indices.indices[t.y + i]));
        int count = cutTriangle(map, p, parts);
        for (int i = 0; i < 3 * count; i += 3) {
            vec3 q[3];
            for (int k = 0; k < 3; k++) q[k] = isFlat(map) ? flatFromWorld(map, parts[i + k]) : parts[i + k];
            assign(map, VoxelPiece(q[0], index, q[1], cascade, q[2], 0));
        }
    }
}
