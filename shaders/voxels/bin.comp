#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the bricks that large triangles touch, one group per triangle. A thread takes one column of bricks,
// along the dominant axis of the triangle or along depth in curved cells. It visits only the bricks near the
// triangle's plane.
#include "params.glsl"
#include "voxels/pieces.glsl"

layout(local_size_x = 32) in;

void note(VolumeMap map, VoxelPiece p, CellRange r, uint i, ivec3 brick) {
    ivec3 first = brick * BRICK;
    if (!touches(map, p, first, ivec3(BRICK), 0.5)) return;
    uint k = atomicAdd(voxelCounter.touched, 1);
    if (k < voxelTouched.list.length())
        voxelTouched.list[k] = uvec2(i, uint(brick.x + 1024) | uint(brick.y) << 12 | uint(brick.z) << 22);
    else storeCells(map, p, CellRange(max(r.from, first), min(r.to, first + BRICK - 1)));
}

void main() {
    uint count = min(voxelCounter.pieces, voxelPieces.list.length());
    for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
        VoxelPiece p = voxelPieces.list[i];
        VolumeMap map = volume.maps[p.cascade];
        CellRange r = rangeOf(map, p);
        ivec3 first = r.from >> 2, extent = (r.to >> 2) - first + 1;
        vec3 face = cross(p.b - p.a, p.c - p.a), steep = abs(face);
        int k = isFlat(map) ? int(dominantAxis(face)) : 2;
        int x = k == 0 ? 1 : 0,
            y = k == 2 ? 1 : 2;
        bool has_plane = isFlat(map) && face[k] != 0.0;
        float least = min(p.a[k], min(p.b[k], p.c[k])), most = max(p.a[k], max(p.b[k], p.c[k]));
        for (int t = int(gl_LocalInvocationIndex); t < extent[x] * extent[y]; t += int(gl_WorkGroupSize.x)) {
            ivec3 brick = first;
            brick[x] += t % extent[x];
            brick[y] += t / extent[x];
            int start = first[k], end = first[k] + extent[k] - 1;
            if (has_plane) { // depth range of the plane over the column
                vec3 low = flatOfCells(map, vec3(brick * BRICK)),
                    edge = flatOfCells(map, vec3(brick * BRICK + BRICK)) - low;
                vec3 middle = low + 0.5 * edge;
                float depth = p.a[k]
                    - (face[x] * (middle[x] - p.a[x]) + face[y] * (middle[y] - p.a[y])) / face[k];
                float reach = 0.5 * (steep[x] * edge[x] + steep[y] * edge[y]) / steep[k] + 0.01;
                vec3 from = low, to = low;
                from[k] = clamp(depth - reach, least, most);
                to[k] = clamp(depth + reach, least, most);
                start = max(int(floor(cellsOfFlat(map, from)[k] - 1e-3)) >> 2, start);
                end = min(int(floor(cellsOfFlat(map, to)[k] + 1e-3)) >> 2, end);
            }
            if (!isFlat(map)) {
                vec2 corner = vec2(brick.xy * BRICK),
                    depths = curvedDepths(map, p.a, p.b, p.c, corner - 0.5, corner + float(BRICK) + 0.5);
                start = max(int(floor(depths.x)) >> 2, start);
                end = min(int(floor(depths.y)) >> 2, end);
            }
            for (brick[k] = start; brick[k] <= end; brick[k]++) note(map, p, r, i, brick);
        }
    }
}
