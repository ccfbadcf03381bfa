// The voxel volume: world <-> volume coordinates u in [0,1]^3 (thesis, Sections 4.1 and 4.6). Cells are not
// cubes in general, and under a warp not equal: every length below is local.
// A volume has one or several cascades, finest first, all with the same number of cells: boxes of growing
// edge around the camera (a clipmap; thesis, Section 6.1), or curved cells followed by boxes. Textures store
// the cascades one behind the other along z.
#ifndef VOLUME_GLSL
#define VOLUME_GLSL

// Placement of a cascade's cells.
struct VolumeMap {
    vec3 minimum; // world corner [m]
    uint curved; // 1: cells fill a frustum or spheres
    vec3 size; // [m]
    float last; // coarsest level that cones read
    vec3 cell; // size / voxel_dim, before warping [m]
    vec3 eye; // centre of curved cells, world
    vec3 axis_x; // frustum: half the width at unit depth, world
    vec3 axis_y; // frustum: half the height, downwards
    vec3 axis_z; // view direction
    vec2 range; // near, far [m]
    vec3 seen_from; // the camera, which `eye` follows in steps; 0 if the volume does not follow
    ivec3 history_from; // first reprojected cell
    ivec3 history_to; // end of reprojected cells, exclusive; their content is last frame's
    ivec3 shift; // since last frame [cells]
};

const uint MAX_CASCADES = 6;

layout(std430) buffer Volume {
    VolumeMap maps[MAX_CASCADES];
    uint signature; // hash of the settings that affect its voxels
} volume;

bool inVolume(vec3 u) {
    return all(equal(clamp(u, 0.0, 1.0), u));
}

// Converts a cell from texture coordinates to those of its cascade.
ivec3 cellOfStored(ivec3 stored, int cascade) {
    return ivec3(stored.xy, stored.z - cascade * params.voxel_dim);
}

bool inGrid(ivec3 cell) {
    return all(lessThan(uvec3(cell), uvec3(params.voxel_dim))); // negative numbers wrap to large ones
}

// worldToVolume, volumeToWorld, cellAxes, cellsPerMetre of a map.
#include "modules/warp.glsl"

// Edge lengths of the level-0 cell at p [m].
vec3 cellSize(VolumeMap map, vec3 p) {
    mat3 a = cellAxes(map, p);
    return vec3(length(a[0]), length(a[1]), length(a[2]));
}

// Length of a level-0 cell along the unit vector d at p, 1 / (cells crossed per metre) [m], and d in cells,
// unit length.
void cellAlong(VolumeMap map, vec3 p, vec3 d, out float cell, out vec3 dir) {
    vec3 crossed = cellsPerMetre(map, p, d);
    float crossings = CURVED ? max(length(crossed), 1e-6) : length(crossed);
    cell = 1.0 / crossings;
    dir = crossed / crossings;
}

float cellLength(VolumeMap map, vec3 p, vec3 d) {
    float cell;
    vec3 dir;
    cellAlong(map, p, d, cell, dir);
    return cell;
}

// Half the extent of a cell along the plane normal n: a plane through the cell's centre just leaves the cell
// when it moves this far [m].
float cellReach(VolumeMap map, vec3 p, vec3 n) {
    vec3 a = abs(n * cellAxes(map, p));
    return 0.5 * (a.x + a.y + a.z);
}

// CASCADE_COUNT, cascadeAt, storedCell, cascadeOf, isReprojected.
#include "modules/clipmap.glsl"

// Centre of a stored cell, in its cascade's volume coordinates.
vec3 cellCentre(ivec3 stored) {
    return (vec3(stored.xy, stored.z - cascadeOf(stored) * params.voxel_dim) + 0.5) / float(params.voxel_dim);
}

#endif
