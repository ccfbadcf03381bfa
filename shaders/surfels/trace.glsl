// Ray tracing against surfel planes: exact near the origin, where filtered levels are too coarse.
#ifndef CONE_NEAR_GLSL
#define CONE_NEAR_GLSL
#include "cones/origin.glsl"
#include "surfels/surfels.glsl"
#include "voxels/bricks.glsl"

// Buffers that rays read. A shader may define others before it includes this file.
#ifndef HIT_SURFELS
#define HIT_SURFELS surfels
#define HIT_RADIANCE sideRadiance
#define HIT_BRICKS voxelBricks
#define HIT_BLOCKS voxelBlocks
#endif

// Extends planes beyond their cell, so that rays find no gaps between neighbours of different slope [voxels].
const float PLANE_MARGIN = 0.05;

struct SurfelHit {
    float distance; // of the hit; on a miss, the distance searched [m]
    vec4 light; // radiance and 1, or 0 on a miss
    float emitted; // share of the radiance that sampled emitters emit
};

// Intersects a ray from `at` along `dir` with a cell's surfels between `enter` and `leave`. Returns the
// distance if it is less than `end`, else `end` [cells]. `facing`: normal of the surface that the ray leaves.
// `met`: index of the side that is hit.
float intersectCell(uint found, ivec3 cell, vec3 at, vec3 dir, vec3 facing, float enter, float leave,
    float end, out uint met) {
    uint surfel = firstSurfel(found), met_behind = 0;
    float nearest = end, behind = end;
    met = 0;
    for (uint axis = 0; axis < 3; axis++) {
        if ((found >> axis & 1u) == 0) continue;
        uint quad = surfelBase(surfel) >> 2, number = sideIndex(surfel++, 0);
        uvec4 first = HIT_SURFELS.quads[quad];
        uint own = first.x >> 30;
        for (uint side = 0; side < SIDES; side++) {
            if ((own >> side & 1u) == 0) continue;
            Plane plane = unpackPlane(first[side], axis);
            vec3 middle = vec3(cell) + 0.5 + plane.offset * axisVector(axis);
            float slope = dot(plane.normal, dir),
                t = dot(plane.normal, middle - at) / (abs(slope) > 1e-4 ? slope : 1e-4);
            if (t < 0.0 || t < enter - PLANE_MARGIN || t > leave + PLANE_MARGIN || t >= nearest) continue;
            vec2 place = lateralOf(at + t * dir - vec3(cell), axis);
            if (!isCovered(SIDES == 1 ? first.yz :
                    side == 0 ? first.zw :
                    HIT_SURFELS.quads[quad + 1].xy, place)) continue;
            if ((side == 0) == (slope < 0.0)) {
                nearest = t;
                met = number + side;
                continue;
            }
            // Back face. If the other side is covered here too, the ray hits that side. The back of the
            // surface that the ray leaves does not count: within 1.5 cells its plane may be in front of the
            // origin.
            if (t >= behind || own == 3
                && isCovered(side == 0 ? HIT_SURFELS.quads[quad + 1].xy : first.zw, place)) continue;
            if (t < 1.5 && dot(plane.normal, facing) * slope > 0.0) continue;
            behind = t;
            met_behind = number + 1 - side;
        }
    }
    // A front face wins: planes are inexact, and near an edge the back of one face may precede the other's
    // front.
    if (nearest < end) return nearest;
    met = met_behind;
    return behind;
}

// Whether straight rays can be traced from here: not in curved cells.
bool hasSurfels(ConeOrigin o) {
    return !CURVED || volume.maps[o.cascade].curved == 0;
}

// First surface between `from` and `range` [m] along d in one cascade. Visits cells one by one (Amanatides
// and Woo 1987), and crosses empty blocks, bricks and 2x2x2 cells in one step.
SurfelHit traceCascade(int cascade, ConeOrigin o, vec3 d, float from, float range) {
    VolumeMap map = volume.maps[cascade];
    float voxel;
    vec3 dir;
    cellAlong(map, o.surface, d, voxel, dir);
    dir = mix(dir, vec3(1e-9), lessThan(abs(dir), vec3(1e-9)));
    vec3 at = worldToVolume(map, o.surface) * float(params.voxel_dim),
        facing = o.normal * cellAxes(map, o.surface);
    vec3 inverse = 1.0 / dir;
    bvec3 ahead = greaterThan(dir, vec3(0.0));
    float enter = from / voxel, end = range / voxel;
    ivec3 cell = ivec3(floor(at + enter * dir));
    uvec4 bricks = uvec4(0), cells = uvec4(0);
    uint last_block = ~0u, last = ~0u;
    for (int i = 0; i < 3 * params.voxel_dim && enter < end && inGrid(cell); i++) {
        uint block = blockIndex(cell, cascade);
        if (block != last_block) bricks = HIT_BLOCKS.list[block];
        last_block = block;
        uint brick = placeOf(cell >> 2), stored = bricks[wordOf(brick)], bit = 0;
        // Edge of the region that is crossed in one step [cells].
        int edge = bricks.xy == uvec2(0) ? 16 : 4;
        if ((stored & bitOf(brick)) != 0) {
            uint place = placeOf(cell), number = 2 * brickIndex(bricks, brick) + wordOf(place);
            if (number != last) cells = HIT_BRICKS.words[number];
            last = number;
            uint occupied = occupiedCells(cells);
            bit = occupied & bitOf(place);
            edge = (occupied & eightAround(place)) == 0 ? 2 : 1;
        }
        ivec3 first = cell & -edge;
        vec3 borders = (vec3(mix(first, first + edge, ahead)) - at) * inverse;
        float leave = min(borders.x, min(borders.y, borders.z));
        if (bit != 0) {
            uint met;
            float t = intersectCell(foundIn(cells, bit), cell, at, dir, facing, enter, leave, end, met);
            if (t < end) {
                uvec2 packed = HIT_RADIANCE.list[met];
                return SurfelHit(t * voxel, vec4(lightOf(packed), 1.0), timesOf(packed));
            }
        }
        bvec3 crossed = equal(borders, vec3(leave));
        ivec3 next = clamp(ivec3(floor(at + leave * dir)), first, first + edge - 1);
        cell = mix(next, mix(first - 1, first + edge, ahead), crossed);
        enter = leave;
    }
    return SurfelHit(min(enter, end) * voxel, vec4(0.0), 0.0); // nothing is known outside the grid
}

// First surface within `range` [m] along d. Continues from each cascade into the next coarser one.
SurfelHit traceSurfels(ConeOrigin o, vec3 d, float range) {
    SurfelHit met = SurfelHit(0.0, vec4(0.0), 0.0);
    for (int k = o.cascade; k < CASCADE_COUNT && met.light.a == 0.0 && met.distance < range; k++)
        met = traceCascade(k, o, d, met.distance, range);
    return met;
}

#endif
