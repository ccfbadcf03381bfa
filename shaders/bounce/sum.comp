#version 460
#extension GL_GOOGLE_include_directive : require
// Sums gathered and reflected light over the sides that have gathered in all short rounds so far. The next
// pass adds the partial sums of the groups.
#include "params.glsl"
#include "volume/volume.glsl"
#include "surfels/sides.glsl"
#include "bounce/gathered.glsl"
#include "bounce/rounds.glsl"
#include "bounce/sums.glsl"

layout(local_size_x = SUM_THREADS) in;

// Area of a side [m2]. Mirrored sides count 0: the inside of a solid has no part in the balance.
float areaOf(uint surfel, uint side) {
    ivec3 cell = cellOfSurfel(surfel);
    VolumeMap map = volume.maps[cascadeOf(cell)];
    float cubed = abs(determinant(cellAxes(map, volumeToWorld(map, cellCentre(cell)))));
    return float(surfelSums.words[sideBase(surfel, side) + 3]) * pow(cubed, 2.0 / 3.0);
}

void main() {
    uint round = bounceRounds.state.frame / shortRound(), count = voxelCounter.count * SIDES;
    BounceSums sums = BounceSums(vec3(0.0), vec3(0.0), vec3(0.0));
    for (uint i = gl_GlobalInvocationID.x; i < count; i += SUM_GROUPS * SUM_THREADS) {
        SideLight g = sideLightOf(sideGathered.list[i]);
        uint surfel = i / SIDES, side = i % SIDES;
        if (axisOfSurfel(surfel) < 0 || g.updates != round) continue;
        vec3 light = areaOf(surfel, side) * g.light;
        vec3 reflected = sideOfSurfel(surfel, side).color * light;
        sums = plus(sums, BounceSums(light, (1.0 - g.first) * light, reflected));
    }
    sums = groupSum(sums);
    if (gl_LocalInvocationIndex == 0) bouncePartials.list[gl_WorkGroupID.x] = sums;
}
