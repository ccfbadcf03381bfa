// Intersection of a ray with the surfels of one cell.
#ifndef SURFEL_INTERSECT_GLSL
#define SURFEL_INTERSECT_GLSL
#include "surfels/surfels.glsl"

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
    uint side; // index of the side that is hit
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
            vec2 lateral = lateralOf(at + t * dir - vec3(cell), axis);
            if (!isCovered(side == 0 ? first.zw : HIT_SURFELS.quads[quad + 1].xy, lateral)) continue;
            if ((side == 0) == (slope < 0.0)) {
                nearest = t;
                met = number + side;
                continue;
            }
            // Back face. If the other side is covered here too, the ray hits that side. The back of the
            // surface that the ray leaves does not count: within 1.5 cells its plane may be in front of the
            // origin.
            if (t >= behind || own == 3
                && isCovered(side == 0 ? HIT_SURFELS.quads[quad + 1].xy : first.zw, lateral)) continue;
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

#endif
