#version 460
#extension GL_GOOGLE_include_directive : require
// Writes the mean plane of each side of a surfel. Coverage masks are merged already.
#include "params.glsl"
#include "common/volume.glsl"
#include "common/voxels.glsl"
#include "common/surfels.glsl"
#include "modules/merge.glsl"

layout(local_size_x = 128) in;

void main() {
    uint surfel = gl_GlobalInvocationID.x;
    if (surfel >= voxelCounter.count || axisOfSurfel(surfel) < 0) return;
    ivec3 cell = cellOfSurfel(surfel);
    uint axis = uint(axisOfSurfel(surfel)), base = surfelBase(surfel);
    VolumeMap map = volume.maps[cascadeOf(cell)];
    mat3 axes = cellAxes(map, volumeToWorld(map, cellCentre(cell)));
    uint present = 0;
    for (uint side = 0; side < SIDES; side++) present |= uint(surfelSums.words[sideBase(surfel, side) + 3] != 0) << side;
    for (uint side = 0; side < SIDES; side++) {
        uint seen = SIDES == 1 || (present >> side & 1u) != 0 ? side : 1 - side, sums = sideBase(surfel, seen);
        vec3 color, normal;
        mergedMean(sums, color, normal);
        float offset = offsetOfSum(float(surfelSums.words[sums + SIDE_OFFSET]), float(surfelSums.words[sums + 3]));
        storePlane(planeWord(base, side), (seen == 0 ? normal : -normal) * axes, axis, offset, present);
        for (uint k = 0; seen != side && k < 2; k++) storeSurfelData(coverageMaskWord(base, side) + k, surfelData(coverageMaskWord(base, seen) + k));
    }
}
