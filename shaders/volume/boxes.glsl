// Cells in a box, warped axis by axis. The warp function defines: warp, a monotonic bijection of [0,1] with
// its densest point at 0.5; warpSlope, its derivative, the cell density relative to no warp; unwarp, its
// exact inverse.
const bool CURVED = false;

// Points outside the volume give results outside [0,1].
vec3 worldToVolume(VolumeMap map, vec3 p) {
    vec3 x = (p - map.minimum) / map.size;
    return mix(x, warp(x), equal(clamp(x, 0.0, 1.0), x));
}

vec3 volumeToWorld(VolumeMap map, vec3 u) {
    return map.minimum + unwarp(u) * map.size;
}

// Columns: world vectors that span the level-0 cell at p [m].
mat3 cellAxes(VolumeMap map, vec3 p) {
    vec3 c = map.cell / warpSlope(clamp((p - map.minimum) / map.size, 0.0, 1.0));
    return mat3(c.x, 0, 0, 0, c.y, 0, 0, 0, c.z);
}

// Cells crossed per metre along d at p.
vec3 cellsPerMetre(VolumeMap map, vec3 p, vec3 d) {
    return d * warpSlope(clamp((p - map.minimum) / map.size, 0.0, 1.0)) / map.cell;
}

bool holds(VolumeMap map, vec3 p) {
    return inVolume(worldToVolume(map, p));
}

// Flat coordinates, 0 to voxel_dim: triangles stay flat and cells are boxes. The next two functions
// convert cells to and from them, axis by axis.
vec3 flatFromWorld(VolumeMap map, vec3 p) {
    return (p - map.minimum) / map.size * float(params.voxel_dim);
}

vec3 flatOfCells(VolumeMap map, vec3 cells) {
    if (!WARPED) return cells;
    vec3 u = cells / float(params.voxel_dim), in_volume = clamp(u, 0.0, 1.0);
    return mix(u, unwarp(in_volume), equal(in_volume, u)) * float(params.voxel_dim);
}

vec3 cellsOfFlat(VolumeMap map, vec3 f) {
    if (!WARPED) return f;
    vec3 x = f / float(params.voxel_dim), in_volume = clamp(x, 0.0, 1.0);
    return mix(x, warp(in_volume), equal(in_volume, x)) * float(params.voxel_dim);
}

bool isFlat(VolumeMap map) {
    return true;
}

// Near plane of the cells, which clips triangles, and depth of a point. Boxes have none.
bool hasNear(VolumeMap map) {
    return false;
}

float flatDepth(VolumeMap map, vec3 p) {
    return 1.0;
}

// Stubs of the functions for curved cells.
#include "volume/flat_only.glsl"

const vec3 CURVED_BORDERS = vec3(1.0);
const bool CURVED_SEAM = false;

int curvedOutside(VolumeMap map, vec3 a, vec3 b, vec3 c) {
    return -1;
}

vec3 curvedEye(vec3 position, vec3 cell) {
    return position;
}
