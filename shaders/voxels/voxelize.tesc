#version 460
#extension GL_GOOGLE_include_directive : require
// Tessellation levels from edge lengths in cells (thesis, Section 4.1.2).
#include "params.glsl"
#include "volume/volume.glsl"
#include "voxels/tessellated.glsl"

layout(vertices = 3) out;

layout(location = 0) in vec3 in_position[];
layout(location = 1) in vec3 in_normal[];
layout(location = 2) in vec4 in_uv[];
layout(location = 3) flat in uint in_material[];
layout(location = 5) in vec4 in_color[];

layout(location = 0) out vec3 position[];
layout(location = 1) out vec3 normal[];
layout(location = 2) out vec4 uv[];
layout(location = 3) patch out uint material;
layout(location = 4) patch out vec2 footprint; // texture coordinates per cell, of both sets
layout(location = 5) patch out uint single; // 1: one cell contains the whole triangle
layout(location = 6) patch out float spacing; // between points [m]
layout(location = 7) out vec4 color[];

#include "modules/tess_levels.glsl"

// Whether a triangle adds nothing to a cascade: it is outside, or all its cells are reprojected.
bool outside(VolumeMap map, vec3 a, vec3 b, vec3 c) {
    int whole = map.curved != 0 ? curvedOutside(map, a, b, c) : -1;
    if (whole >= 0) return whole == 1;
    vec3 u = worldToVolume(map, a), v = worldToVolume(map, b), w = worldToVolume(map, c);
    vec3 low = min(u, min(v, w)), high = max(u, max(v, w));
    if (isReprojected(map, low * float(params.voxel_dim))
        && isReprojected(map, high * float(params.voxel_dim)))
        return true;
    return any(lessThan(high, vec3(0.0))) || any(greaterThan(low, vec3(1.0)));
}

void main() {
    position[gl_InvocationID] = in_position[gl_InvocationID];
    normal[gl_InvocationID] = in_normal[gl_InvocationID];
    uv[gl_InvocationID] = in_uv[gl_InvocationID];
    color[gl_InvocationID] = in_color[gl_InvocationID];
    if (gl_InvocationID != 0) return;

    // Reads inputs only: reading the outputs of other invocations would need a barrier.
    vec3 a = in_position[0], b = in_position[1], c = in_position[2];
    material = in_material[0];
    // The cascade that needs most points sets the levels. All cascades are voxelized in the same pass.
    int finest = -1;
    vec3 cells = vec3(0.0);
    for (int k = 0; k < tessellatedCascades(); k++) {
        VolumeMap map = volume.maps[k];
        if (outside(map, a, b, c)) continue;
        vec3 along = vec3(cellsAlong(map, b, c), cellsAlong(map, c, a), cellsAlong(map, a, b))
            * params.tess_rate;
        if (finest < 0 || max(along.x, max(along.y, along.z)) > max(cells.x, max(cells.y, cells.z))) {
            finest = k;
            cells = along;
        }
    }
    if (finest < 0) {
        gl_TessLevelOuter = float[4](0.0, 0.0, 0.0, 0.0); // discards the patch
        gl_TessLevelInner = float[2](0.0, 0.0);
        footprint = vec2(0.0);
        single = 0;
        spacing = 0.0;
        return;
    }
    VolumeMap map = volume.maps[finest];
    float longest = max(cells.x, max(cells.y, cells.z));

    // Outer level i belongs to the edge opposite vertex i. A level of 0 would discard the patch, so small
    // triangles get 1.
    gl_TessLevelOuter = float[4](max(cells.x, 1.0), max(cells.y, 1.0), max(cells.z, 1.0), 1.0);
    vec3 face = cross(b - a, c - a);
    float inner = innerLevel(map, a, b, c, longest);
    gl_TessLevelInner = float[2](max(inner, 1.0), 1.0);

    ivec3 home = ivec3(floor(worldToVolume(map, a) * float(params.voxel_dim)));
    single = uint(home == ivec3(floor(worldToVolume(map, b) * float(params.voxel_dim)))
               && home == ivec3(floor(worldToVolume(map, c) * float(params.voxel_dim))));
    if (single != 0) {
        gl_TessLevelOuter = float[4](1.0, 1.0, 1.0, 1.0);
        gl_TessLevelInner = float[2](1.0, 1.0);
    }

    spacing = max(distance(a, b), max(distance(b, c), distance(c, a)))
        / clamp(gl_TessLevelInner[0], 1.0, 64.0);

    // Square root of the area ratio of texture coordinates and surface, times the mean cell edge.
    vec4 s = in_uv[1] - in_uv[0], t = in_uv[2] - in_uv[0];
    vec3 size = cellSize(map, (a + b + c) / 3.0);
    float area = max(length(face), 1e-20);
    footprint = sqrt(abs(s.xz * t.yw - s.yw * t.xz) / area) * (size.x + size.y + size.z) / 3.0;
}
