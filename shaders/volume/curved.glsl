// A first cascade of curved cells, followed by boxes with cells of equal size. The module defines
// curvedFromWorld, curvedToWorld, curvedAxes and curvedHolds for the curved cells.
const bool WARPED = true, CURVED = true;

#include "volume/unwarped.glsl"

// Points outside the volume give results outside [0,1].
vec3 worldToVolume(VolumeMap map, vec3 p) {
    return map.curved == 0 ? (p - map.minimum) / map.size : curvedFromWorld(map, p);
}

vec3 volumeToWorld(VolumeMap map, vec3 u) {
    return map.curved == 0 ? map.minimum + u * map.size : curvedToWorld(map, u);
}

// Columns: world vectors that span the level-0 cell at p [m].
mat3 cellAxes(VolumeMap map, vec3 p) {
    if (map.curved != 0) return curvedAxes(map, p);
    return mat3(map.cell.x, 0, 0, 0, map.cell.y, 0, 0, 0, map.cell.z);
}

// Cells crossed per metre along d at p.
vec3 cellsPerMetre(VolumeMap map, vec3 p, vec3 d) {
    if (map.curved == 0) return d / map.cell;
    return inverse(curvedAxes(map, p)) * d;
}

// Flat coordinates: triangles stay flat and cells are boxes, voxel_dim along an edge. The next two functions
// convert cells to and from them, axis by axis. The module defines curvedFlat, flatOfCurved, curvedOfFlat and
// FLAT, which is false if its cells have no flat coordinates.
vec3 flatFromWorld(VolumeMap map, vec3 p) {
    return map.curved == 0 ? (p - map.minimum) / map.size * float(params.voxel_dim) : curvedFlat(map, p);
}

vec3 flatOfCells(VolumeMap map, vec3 cells) {
    return map.curved == 0 ? cells : flatOfCurved(map, cells);
}

vec3 cellsOfFlat(VolumeMap map, vec3 f) {
    return map.curved == 0 ? f : curvedOfFlat(map, f);
}

bool isFlat(VolumeMap map) {
    return FLAT || map.curved == 0;
}

// Near plane of the cells, which clips triangles, and depth of a point.
bool hasNear(VolumeMap map) {
    return FLAT && map.curved != 0;
}

float flatDepth(VolumeMap map, vec3 p) {
    return dot(p - map.eye, map.axis_z);
}

bool holds(VolumeMap map, vec3 p) {
    return map.curved == 0 ? inVolume(worldToVolume(map, p)) : curvedHolds(map, p);
}
