// Exact tracing of a ray against surfel planes, up to a range that callers choose.
#ifndef SURFEL_TRACE_GLSL
#define SURFEL_TRACE_GLSL
#include "cones/origin.glsl"
#include "voxels/bricks.glsl"
#include "surfels/intersect.glsl"

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
        uint brick = indexInBrick(cell >> 2), stored = bricks[wordOf(brick)], bit = 0;
        // Edge of the region that is crossed in one step [cells].
        int edge = bricks.xy == uvec2(0) ? 16 : 4;
        if ((stored & bitOf(brick)) != 0) {
            uint local = indexInBrick(cell), number = 2 * brickIndex(bricks, brick) + wordOf(local);
            if (number != last) cells = HIT_BRICKS.words[number];
            last = number;
            uint occupied = occupiedCells(cells);
            bit = occupied & bitOf(local);
            edge = (occupied & eightAround(local)) == 0 ? 2 : 1;
        }
        ivec3 first = cell & -edge;
        vec3 borders = (vec3(mix(first, first + edge, ahead)) - at) * inverse;
        float leave = min(borders.x, min(borders.y, borders.z));
        if (bit != 0) {
            uint met;
            float t = intersectCell(foundIn(cells, bit), cell, at, dir, facing, enter, leave, end, met);
            if (t < end) {
                uvec2 packed = HIT_RADIANCE.list[met];
                return SurfelHit(t * voxel, vec4(lightOf(packed), 1.0), numberOf(packed), met);
            }
        }
        bvec3 crossed = equal(borders, vec3(leave));
        ivec3 next = clamp(ivec3(floor(at + leave * dir)), first, first + edge - 1);
        cell = mix(next, mix(first - 1, first + edge, ahead), crossed);
        enter = leave;
    }
    return SurfelHit(min(enter, end) * voxel, vec4(0.0), 0.0, 0u); // nothing is known outside the grid
}

// First surface within `range` [m] along d. Continues from each cascade into the next coarser one.
SurfelHit traceSurfels(ConeOrigin o, vec3 d, float range) {
    SurfelHit met = SurfelHit(0.0, vec4(0.0), 0.0, 0u);
    for (int k = o.cascade; k < CASCADE_COUNT && met.light.a == 0.0 && met.distance < range; k++)
        met = traceCascade(k, o, d, met.distance, range);
    return met;
}

#endif
