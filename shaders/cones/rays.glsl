// What cones approximate: rays through the level-0 voxels, met one by one. Costs a hundred times a cone, and says what
// of an image's error is the voxels', the cones' and the filtering's.
#ifndef VOXEL_RAYS_GLSL
#define VOXEL_RAYS_GLSL
#include "cones/origin.glsl"
#include "common/random.glsl"

vec2 pixelCentre();

// A turn of the sample pattern for each pixel, so that few rays look like noise and not like bands.
vec2 rayShift(uint cone) {
    Random random = Random(uvec4(uvec2(pixelCentre()), cone, 0u));
    return next4(random).xy;
}

// Point i of an additive recurrence that fills the square evenly (Roberts 2018, R2).
vec2 rayPoint(int i, vec2 shift) {
    return fract(shift + float(i) * vec2(0.7548776662, 0.5698402910));
}

// What a ray along d (unit length, in cells) finds in a cell, for each cell's length that it goes there.
vec4 texelAlong(ivec3 cell, vec3 d) {
    if (params.radiance_faces == 1) return texelFetch(voxelRadiance, cell, 0);
    vec4 sum = vec4(0.0);
    for (int axis = 0; axis < 3; axis++)
        sum += abs(d[axis]) * texelFetch(voxelRadiance, ivec3(cell.x + (2 * axis + (d[axis] < 0.0 ? 1 : 0)) * params.voxel_dim, cell.yz), 0);
    return sum;
}



#include "modules/rays.glsl"

#endif
