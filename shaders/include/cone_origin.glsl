// Where cones start, and what they read.
#ifndef CONE_ORIGIN_GLSL
#define CONE_ORIGIN_GLSL
#include "volume.glsl"

uniform sampler3D voxelRadiance; // premultiplied by opacity; border clamped

struct ConeOrigin {
    vec3 position; // off the surface
    vec3 normal; // geometric: the plane that cones must stay above
    float height; // of position above the surface [m]
    float reach; // half the local cell's extent across the surface [m]
    int block; // of the volume, that the surface lies in
    float share; // of it; of the next one, the rest: so that no seam shows where a block ends
};

// `geometric` keeps the start outside the voxels of its own surface; the thesis goes `bias` voxels along the
// shading normal, which can point into the geometry.
ConeOrigin coneOrigin(vec3 p, vec3 geometric, vec3 shading) {
    int block = blockAt(p);
    Grid g = volume.grids[block];
    float reach = cellReach(g, p, geometric), share = 1.0;
    if (BLOCKS > 1 && block < BLOCKS - 1) {
        share = shareOfBlock(worldToVolume(g, p), 0.0);
        reach = mix(cellReach(volume.grids[block + 1], p, geometric), reach, share);
    }
    if (params.cone_origin == CONE_ORIGIN_SHADING) {
        vec3 start = p + params.bias * cellLength(g, p, shading) * shading;
        return ConeOrigin(start, geometric, max(dot(start - p, geometric), 0.0), reach, block, share);
    }
    float height = 2.0 * params.bias * reach;
    return ConeOrigin(p + height * geometric, geometric, height, reach, block, share);
}

#endif
