// The voxel volume: world <-> volume coordinates u in [0,1]^3, after warping (thesis, Section 4.6).
// Cells are not cubes in general, and under a warp not equal: every length below is local.
// A volume is one block of cells, or several, finest first and all with as many cells: boxes of doubling edge around the
// camera (a clipmap; thesis, Section 6.1), or a warped block with a uniform one behind it. Textures hold the blocks one
// behind the other along z.
#ifndef VOLUME_GLSL
#define VOLUME_GLSL

struct Grid {
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
    vec3 seen_from; // the camera, which `eye` follows in steps
    ivec3 kept_from; // cells from here ...
    ivec3 kept_to; // ... to before here hold what they held last frame, wherever they were then
    ivec3 shift; // in cells, since last frame
};

const uint MAX_BLOCKS = 6;

#ifndef VOLUME_ACCESS
#define VOLUME_ACCESS readonly
#endif
layout(std430) VOLUME_ACCESS buffer Volume { Grid grids[MAX_BLOCKS]; } volume;

// voxels.ron says the same in `curved` and `blocks`.
#define CURVED (WARP == WARP_PERSPECTIVE || WARP == WARP_SPHERICAL)
#define BLOCKS (!CURVED ? CASCADES : FALLBACK ? 1 + CASCADES : 1)

const float TURN = 6.28318530718;
const float POLE = 0.1; // cells nearer to the axis of a spherical block are not taken for narrower than here (a sine)

// Monotonic bijections of [0,1] with their densest point at .5; the inverses are exact.
vec3 warp(vec3 x) {
    if (WARP == WARP_SPLINE) {
        float a = params.warp_alpha;
        return x * (a + x * (3.0 - 3.0 * a + x * (2.0 * a - 2.0)));
    }
    if (WARP == WARP_LOGISTIC) {
        // .5 + .5 tanh(s/2 (x - 1/2)) / tanh(s/4), whose difference of tanh would cancel at the borders.
        float s = params.warp_steepness;
        vec3 folded = 0.5 - abs(x - 0.5);
        vec3 y = sinh(0.5 * s * folded) / (2.0 * sinh(0.25 * s) * cosh(0.5 * s * (0.5 - folded)));
        return mix(y, 1.0 - y, greaterThan(x, vec3(0.5)));
    }
    return x;
}

// w'(x): local density of cells against no warp.
vec3 warpSlope(vec3 x) {
    if (WARP == WARP_SPLINE) {
        float a = params.warp_alpha;
        return a + x * (6.0 - 6.0 * a + x * (6.0 * a - 6.0));
    }
    if (WARP == WARP_LOGISTIC) {
        float s = params.warp_steepness;
        vec3 t = tanh(0.5 * s * (x - 0.5));
        return 0.25 * s * (1.0 - t * t) / tanh(0.25 * s);
    }
    return vec3(1.0);
}

vec3 unwarp(vec3 y) {
    if (WARP == WARP_SPLINE) {
        // Newton on the convex lower half from its upper end: monotonic, no overshoot.
        vec3 folded = 0.5 - abs(y - 0.5);
        vec3 x = vec3(0.5);
        for (int i = 0; i < 10; i++) x -= (warp(x) - folded) / warpSlope(x);
        return mix(x, 1.0 - x, greaterThan(y, vec3(0.5)));
    }
    if (WARP == WARP_LOGISTIC) {
        float s = params.warp_steepness, e = exp(0.5 * s);
        vec3 folded = 0.5 - abs(y - 0.5);
        vec3 x = log((1.0 + folded * (e - 1.0)) / (1.0 - folded * (1.0 - 1.0 / e))) / s;
        return mix(x, 1.0 - x, greaterThan(y, vec3(0.5)));
    }
    return y;
}

// The angle of (x, y) from the x axis; one step of Newton's method makes it the inverse of this device's sine and cosine.
float angleOf(float x, float y) {
    float t = atan(y, x), r = length(vec2(x, y));
    return r > 0.0 ? t + (y * cos(t) - x * sin(t)) / r : 0.0;
}

// Outside the volume the result is outside [0,1]; behind the camera of a perspective warp it is -1.
vec3 worldToVolume(Grid g, vec3 p) {
    if (!CURVED || g.curved == 0) {
        vec3 x = (p - g.minimum) / g.size;
        if (WARP == WARP_NONE || CURVED) return x;
        return mix(x, warp(x), equal(clamp(x, 0.0, 1.0), x));
    }
    vec3 d = p - g.eye;
    if (WARP == WARP_SPHERICAL) {
        // Azimuth, angle from the vertical axis, logarithm of the distance: cells keep their shape. The axes are the
        // world's, so that a camera that turns moves nothing.
        float r = max(length(d), 1e-6);
        vec2 angles = vec2(angleOf(d.x, d.z) / TURN + 0.5, angleOf(d.y, length(d.xz)) / (0.5 * TURN));
        return vec3(clamp(angles, 0.0, 1.0), log(r / g.range.x) / log(g.range.y / g.range.x));
    }
    float w = dot(d, g.axis_z);
    if (w < 0.5 * g.range.x) return vec3(-1.0);
    vec2 xy = vec2(dot(d, g.axis_x) / dot(g.axis_x, g.axis_x), dot(d, g.axis_y) / dot(g.axis_y, g.axis_y)) / w;
    return vec3(xy * 0.5 + 0.5, (w - g.range.x) / (g.range.y - g.range.x)); // depth linear in metres
}

vec3 volumeToWorld(Grid g, vec3 u) {
    if (!CURVED || g.curved == 0) return g.minimum + (CURVED ? u : unwarp(u)) * g.size;
    if (WARP == WARP_SPHERICAL) {
        float r = g.range.x * pow(g.range.y / g.range.x, u.z), azimuth = TURN * (u.x - 0.5), polar = 0.5 * TURN * u.y;
        return g.eye + r * vec3(sin(polar) * cos(azimuth), cos(polar), sin(polar) * sin(azimuth));
    }
    float w = mix(g.range.x, g.range.y, u.z);
    return g.eye + w * (g.axis_z + (2.0 * u.x - 1.0) * g.axis_x + (2.0 * u.y - 1.0) * g.axis_y);
}

// Columns: the world vectors that span the level-0 cell at p [m].
mat3 cellAxes(Grid g, vec3 p) {
    if (!CURVED || g.curved == 0) {
        vec3 x = clamp((p - g.minimum) / g.size, 0.0, 1.0);
        vec3 c = g.cell / warpSlope(x);
        return mat3(c.x, 0, 0, 0, c.y, 0, 0, 0, c.z);
    }
    vec3 d = p - g.eye;
    float dim = float(params.voxel_dim);
    if (WARP == WARP_SPHERICAL) {
        float far = max(length(d), 1e-6), r = clamp(far, g.range.x, g.range.y);
        vec3 away = d / far;
        float s = length(away.xz);
        vec3 along = s > 0.0 ? vec3(-away.z, 0.0, away.x) / s : vec3(0, 0, 1);
        vec3 down = cross(away, along);
        return mat3(TURN * max(s, POLE) * r / dim * along, 0.5 * TURN * r / dim * down, log(g.range.y / g.range.x) * r / dim * away);
    }
    float w = clamp(dot(d, g.axis_z), g.range.x, g.range.y);
    vec3 along = g.axis_z + (dot(d, g.axis_x) / dot(g.axis_x, g.axis_x) * g.axis_x + dot(d, g.axis_y) / dot(g.axis_y, g.axis_y) * g.axis_y) / w;
    return mat3(2.0 * w / dim * g.axis_x, 2.0 * w / dim * g.axis_y, (g.range.y - g.range.x) / dim * along);
}

// Edge lengths of the level-0 cell at p [m].
vec3 cellSize(Grid g, vec3 p) {
    mat3 a = cellAxes(g, p);
    return vec3(length(a[0]), length(a[1]), length(a[2]));
}

// The unit vector d at p: how long a level-0 cell is along it [m], 1 / (cells crossed per metre), and d in cells, unit length.
void cellAlong(Grid g, vec3 p, vec3 d, out float cell, out vec3 way) {
    vec3 crossed;
    if (WARP == WARP_NONE || CURVED && g.curved == 0) crossed = d / g.cell;
    else if (!CURVED) crossed = d * warpSlope(clamp((p - g.minimum) / g.size, 0.0, 1.0)) / g.cell;
    else crossed = inverse(cellAxes(g, p)) * d;
    float many = CURVED ? max(length(crossed), 1e-6) : length(crossed);
    cell = 1.0 / many;
    way = crossed / many;
}

float cellLength(Grid g, vec3 p, vec3 d) {
    float cell;
    vec3 way;
    cellAlong(g, p, d, cell, way);
    return cell;
}

// Half the extent of a cell across a plane of normal n: a plane through the cell's centre moved by this
// along n just leaves the cell [m].
float cellReach(Grid g, vec3 p, vec3 n) {
    vec3 a = abs(n * cellAxes(g, p));
    return 0.5 * (a.x + a.y + a.z);
}

// Density of cells against no warp, by hue: red below 1/2, green 1, blue from 2 (thesis, Figure 5.7). One
// axis of a warp function; of curved or several blocks the mean edge, against the coarsest block's.
vec3 densityColor(Grid g, vec3 p) {
    vec3 coarsest = volume.grids[BLOCKS - 1].cell;
    float density = CURVED || BLOCKS > 1
        ? pow(coarsest.x * coarsest.y * coarsest.z / max(abs(determinant(cellAxes(g, p))), 1e-20), 1.0 / 3.0)
        : warpSlope(clamp((p - g.minimum) / g.size, 0.0, 1.0))[clamp(params.density_axis, 0, 2)];
    float t = clamp(log2(max(density, 1e-6)), -1.0, 1.0);
    return t < 0.0 ? mix(vec3(0, 1, 0), vec3(1, 0, 0), -t) : mix(vec3(0, 1, 0), vec3(0, 0, 1), t);
}

bool inVolume(vec3 u) {
    return all(equal(clamp(u, 0.0, 1.0), u));
}

bool inGrid(ivec3 cell) {
    return all(greaterThanEqual(cell, ivec3(0))) && all(lessThan(cell, ivec3(params.voxel_dim)));
}

// Towards a block's border, over so many cells of a level, lookups turn into the next block's.
const float BLEND_CELLS = 6.0;

float shareOfBlock(vec3 u, float lod) {
    vec3 inside = min(u, 1.0 - u);
    if (WARP == WARP_SPHERICAL) inside.xy = vec2(1.0); // no borders there
    return clamp(min(inside.x, min(inside.y, inside.z)) * float(params.voxel_dim) / (BLEND_CELLS * exp2(max(lod, 0.0))), 0.0, 1.0);
}

// Whether a place in cells is one whose content stays as it was.
bool isKept(Grid g, vec3 at) {
    return all(greaterThan(at, vec3(g.kept_from))) && all(lessThan(at, vec3(g.kept_to)));
}

// Spheres hold what is far enough and near enough: their angles would cost four trigonometric functions a sample. The
// margin is wider than rounding, so that worldToVolume agrees.
bool holds(Grid g, vec3 p) {
    if (WARP != WARP_SPHERICAL || g.curved == 0) return inVolume(worldToVolume(g, p));
    float r = distance(p, g.eye);
    return r > g.range.x * 1.00001 && r < g.range.y * 0.99999;
}

// The finest block that holds p; else the coarsest.
int blockAt(vec3 p) {
    int k = 0;
    while (k < BLOCKS - 1 && !holds(volume.grids[k], p)) k++;
    return k;
}

// Blocks that the tessellator fills: beside the rasteriser, the curved one.
int tessellatedBlocks() {
    return CURVED && params.voxelizer == VOXELIZER_RASTER ? 1 : BLOCKS;
}

// Where textures keep a block's cell, and back.
ivec3 storedCell(ivec3 cell, int block) {
    return ivec3(cell.xy, cell.z + block * params.voxel_dim);
}

int blockOf(ivec3 stored) {
    return BLOCKS > 1 ? stored.z / params.voxel_dim : 0;
}

// The middle of a stored cell, in its block's coordinates.
vec3 cellCentre(ivec3 stored) {
    return (vec3(stored.xy, stored.z - blockOf(stored) * params.voxel_dim) + 0.5) / float(params.voxel_dim);
}

#endif
