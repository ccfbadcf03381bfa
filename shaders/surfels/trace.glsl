// What a ray meets among the voxels: the planes of their surfaces, exact where filtered levels know too little.
#ifndef CONE_NEAR_GLSL
#define CONE_NEAR_GLSL
#include "cones/origin.glsl"
#include "surfels/surfels.glsl"
#include "voxels/bricks.glsl"

// What rays meet, unless the shader has other names for it.
#ifndef HIT_SURFELS
#define HIT_SURFELS surfels
#define HIT_RADIANCE sideRadiance
#define HIT_BRICKS voxelBricks
#define HIT_BLOCKS voxelBlocks
#endif

// How far planes reach beyond their cell, so that rays find no gaps where neighbours lean differently [voxels].
const float PLANE_MARGIN = 0.05;

struct SurfelHit {
    float distance; // of what is met, or so far nothing is [m]
    vec4 light; // radiance of what is met, and 1; or 0
    float emitted; // share of it that is emitted by what is drawn as an emitter
};

// Which surface of a cell a ray from `at` along `dir` meets between `enter` and `leave`: its distance, less than `end`, or `end`
// [cells]. `facing`: the normal of the surface that the ray leaves. `met`: the number of the side that it meets.
float intersectCell(uint found, ivec3 cell, vec3 at, vec3 dir, vec3 facing, float enter, float leave, float end, out uint met) {
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
            float slope = dot(plane.normal, dir), t = dot(plane.normal, middle - at) / (abs(slope) > 1e-4 ? slope : 1e-4);
            if (t < 0.0 || t < enter - PLANE_MARGIN || t > leave + PLANE_MARGIN || t >= nearest) continue;
            vec2 place = lateralOf(at + t * dir - vec3(cell), axis);
            if (!isCovered(SIDES == 1 ? first.yz : side == 0 ? first.zw : HIT_SURFELS.quads[quad + 1].xy, place)) continue;
            if ((side == 0) == (slope < 0.0)) {
                nearest = t;
                met = number + side;
                continue;
            }
            // From behind: where the other side has a surface, back to back, the ray meets that one. Nor the back of the surface
            // that is left: within a voxel or two its plane may lie before it.
            if (t >= behind || own == 3 && isCovered(side == 0 ? HIT_SURFELS.quads[quad + 1].xy : first.zw, place)) continue;
            if (t < 1.5 && dot(plane.normal, facing) * slope > 0.0) continue;
            behind = t;
            met_behind = number + 1 - side;
        }
    }
    // At an edge a ray may pass the back of one face just before it meets the front of the other: planes are not that exact.
    if (nearest < end) return nearest;
    met = met_behind;
    return behind;
}

// Whether the voxels around have planes that rays can meet: straight rays are not straight in curved cells.
bool hasSurfels(ConeOrigin o) {
    return !CURVED || volume.maps[o.cascade].curved == 0;
}

// The first surface between `from` and `range` [m] along d that a cascade has. Cells one by one (Amanatides and Woo 1987), empty
// bricks and blocks at once, and eights of cells.
SurfelHit traceCascade(int cascade, ConeOrigin o, vec3 d, float from, float range) {
    VolumeMap map = volume.maps[cascade];
    float voxel;
    vec3 dir;
    cellAlong(map, o.surface, d, voxel, dir);
    dir = mix(dir, vec3(1e-9), lessThan(abs(dir), vec3(1e-9)));
    vec3 at = worldToVolume(map, o.surface) * float(params.voxel_dim), facing = o.normal * cellAxes(map, o.surface);
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
        // The edge of what is crossed at once, and where it begins; its borders that are crossed next.
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
    return SurfelHit(min(enter, end) * voxel, vec4(0.0), 0.0); // what lies behind the grid's border is not known here
}

// The first surface within `range` [m] along d, from one cascade into the next coarser.
SurfelHit traceSurfels(ConeOrigin o, vec3 d, float range) {
    SurfelHit met = SurfelHit(0.0, vec4(0.0), 0.0);
    for (int k = o.cascade; k < CASCADE_COUNT && met.light.a == 0.0 && met.distance < range; k++)
        met = traceCascade(k, o, d, met.distance, range);
    return met;
}

#endif
