// A first cascade of curved cells, the others boxes of cells of one size. The module says: the four functions below for
// the curved ones, and curvedHolds.
const bool WARPED = true, CURVED = true;

#include "volume/unwarped.glsl"

// Outside the volume the result is outside [0,1].
vec3 worldToVolume(VolumeMap map, vec3 p) {
    return map.curved == 0 ? (p - map.minimum) / map.size : curvedFromWorld(map, p);
}

vec3 volumeToWorld(VolumeMap map, vec3 u) {
    return map.curved == 0 ? map.minimum + u * map.size : curvedToWorld(map, u);
}

// Columns: the world vectors that span the level-0 cell at p [m].
mat3 cellAxes(VolumeMap map, vec3 p) {
    if (map.curved != 0) return curvedAxes(map, p);
    return mat3(map.cell.x, 0, 0, 0, map.cell.y, 0, 0, 0, map.cell.z);
}

// Cells that a step of a metre along d crosses at p.
vec3 cellsPerMetre(VolumeMap map, vec3 p, vec3 d) {
    if (map.curved == 0) return d / map.cell;
    return inverse(curvedAxes(map, p)) * d;
}

// Coordinates in which triangles are flat and cells are boxes, as long as the volume has cells; and cells in these, axis by axis.
// The module says them for its curved cells, if there are such: curvedFlat, flatOfCurved, curvedOfFlat, FLAT.
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

// How far along its depth a point lies, where cells have a near side that cuts triangles.
bool hasNear(VolumeMap map) {
    return FLAT && map.curved != 0;
}

float flatDepth(VolumeMap map, vec3 p) {
    return dot(p - map.eye, map.axis_z);
}

bool holds(VolumeMap map, vec3 p) {
    return map.curved == 0 ? inVolume(worldToVolume(map, p)) : curvedHolds(map, p);
}
