#version 460
#extension GL_GOOGLE_include_directive : require
// Saves the surfels that this frame reuses from the last, before they are cleared. Planes are last frame's.
#include "params.glsl"
#include "volume/volume.glsl"
#include "surfels/surfels.glsl"
#include "voxels/scrolled.glsl"

layout(local_size_x = 128) in;

void main() {
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint i = gl_GlobalInvocationID.x; i < voxelCounter.count; i += stride) {
        int axis = axisOfSurfel(i);
        ivec3 stored = cellOfSurfel(i);
        int cascade = cascadeOf(stored);
        VolumeMap map = volume.maps[cascade];
        ivec3 cell = cellOfStored(stored, cascade) - map.shift;
        if (axis < 0 || !isReprojected(map, vec3(cell) + 0.5)) continue;
        uint to = atomicAdd(scrolledCounter.count, 1);
        if (to % 128 == 0) {
            atomicAdd(scrolledCounter.groups.x, 1);
            scrolledCounter.groups.yz = uvec2(1);
        }
        uint first = to * SCROLLED_WORDS, base = surfelBase(i);
        for (uint word = 0; word < SURFEL_CELL; word++)
            scrolledSurfels.words[first + word] = surfelSums.words[i * SURFEL_SUM_WORDS + word];
        scrolledSurfels.words[first + SURFEL_CELL] =
            packCell(storedCell(cell, cascade)) | uint(axis + 1) << 30;
        for (uint side = 0; side < SIDES; side++) {
            // A side without surfaces has a copy of the other side's mask: save an empty one.
            bool has_surfaces = surfelSums.words[sideBase(i, side) + 3] != 0;
            for (uint k = 0; k < 2; k++)
                scrolledSurfels.words[first + SCROLLED_MASKS + 2 * side + k] =
                    has_surfaces ? surfelData(coverageMaskWord(base, side) + k) : 0;
            scrolledSurfels.words[first + SCROLLED_MASKS + 2 * SIDES + side] =
                surfelData(frontLayerWord(base, side));
        }
    }
}
