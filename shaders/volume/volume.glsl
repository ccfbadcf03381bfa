// The voxel volume: world <-> volume coordinates u in [0,1]^3 (thesis, Sections 4.1 and 4.6). Cells are not cubes in
// general, and under a warp not equal: every length below is local.
// A volume is one cascade of cells or several, finest first, all with as many cells: boxes of doubling edge around the
// camera (a clipmap; thesis, Section 6.1), or curved cells with boxes behind them. Textures hold the cascades one behind
// the other along z.
#ifndef VOLUME_GLSL
#define VOLUME_GLSL

// Where the cells of a cascade lie.
struct VolumeMap {
    vec3 minimum; // world corner [m]
    uint curved; // 1: cells lie in a frustum or on spheres
    vec3 size; // [m]
    float last; // coarsest level that cones read
    vec3 cell; // size / voxel_dim, before warping [m]
    vec3 eye; // curved: the middle
    vec3 axis_x; // frustum: half its width at unit depth, world
    vec3 axis_y; // half its height, downwards
    vec3 axis_z; // view direction
    vec2 range; // near, far [m]
    vec3 seen_from; // the camera, which `eye` follows in steps; where nothing follows, 0
    ivec3 history_from; // cells from here ...
    ivec3 history_to; // ... to before here hold what they held last frame, wherever they were then
    ivec3 shift; // in cells, since last frame
};

const uint MAX_CASCADES = 6;

layout(std430) buffer Volume {
    VolumeMap maps[MAX_CASCADES];
    uint signature; // of the settings that decide about its voxels
} volume;

bool inVolume(vec3 u) {
    return all(equal(clamp(u, 0.0, 1.0), u));
}

// A cell of a cascade, of one as textures hold it.
ivec3 cellOfStored(ivec3 stored, int cascade) {
    return ivec3(stored.xy, stored.z - cascade * params.voxel_dim);
}

bool inGrid(ivec3 cell) {
    return all(lessThan(uvec3(cell), uvec3(params.voxel_dim))); // below 0 is above all
}

// worldToVolume, volumeToWorld, cellAxes, cellsPerMetre of a map.
#include "modules/warp.glsl"

// Edge lengths of the level-0 cell at p [m].
vec3 cellSize(VolumeMap map, vec3 p) {
    mat3 a = cellAxes(map, p);
    return vec3(length(a[0]), length(a[1]), length(a[2]));
}

// The unit vector d at p: how long a level-0 cell is along it [m], 1 / (cells crossed per metre), and d in cells, unit
// length.
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

// Half the extent of a cell across a plane of normal n: a plane through the cell's centre moved by this along n just
// leaves the cell [m].
float cellReach(VolumeMap map, vec3 p, vec3 n) {
    vec3 a = abs(n * cellAxes(map, p));
    return 0.5 * (a.x + a.y + a.z);
}

// CASCADE_COUNT, cascadeAt, storedCell, cascadeOf, isReprojected.
#include "modules/clipmap.glsl"

// The middle of a stored cell, in its cascade's coordinates.
vec3 cellCentre(ivec3 stored) {
    return (vec3(stored.xy, stored.z - cascadeOf(stored) * params.voxel_dim) + 0.5) / float(params.voxel_dim);
}

#endif
