#version 460
#extension GL_GOOGLE_include_directive : require
// Writes the mean plane of each surfel side, and copies the coverage mask to a side without surfaces. Runs
// after the coverage masks are merged.
#include "params.glsl"
#include "volume/volume.glsl"
#include "voxels/voxels.glsl"
#include "surfels/surfels.glsl"
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
    for (uint side = 0; side < SIDES; side++) {
        uint weight = surfelSums.words[sideBase(surfel, side) + 3];
        present |= uint(weight != 0) << side;
    }
    for (uint side = 0; side < SIDES; side++) {
        uint seen = SIDES == 1 || (present >> side & 1u) != 0 ? side : 1 - side;
        uint sums = sideBase(surfel, seen);
        vec3 color, normal;
        mergedMean(sums, color, normal);
        float sum = float(surfelSums.words[sums + SIDE_OFFSET]), weight = float(surfelSums.words[sums + 3]);
        float offset = offsetOfSum(sum, weight);
        storePlane(planeWord(base, side), (seen == 0 ? normal : -normal) * axes, axis, offset, present);
        if (seen == side) continue;
        uint to = coverageMaskWord(base, side), from = coverageMaskWord(base, seen);
        for (uint k = 0; k < 2; k++) storeSurfelData(to + k, surfelData(from + k));
    }
}
