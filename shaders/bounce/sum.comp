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

// Weight of a side in the balance: its area, times the frames of a round that read its light before it
// gathers. Mirrored sides count 0: the inside of a solid has no part in the balance.
float weightOf(uint surfel, uint side) {
    ivec3 cell = cellOfSurfel(surfel);
    uint phase = phaseOf(uvec3(cell) >> 2, shortRound());
    VolumeMap map = volume.maps[cascadeOf(cell)];
    float cubed = abs(determinant(cellAxes(map, volumeToWorld(map, cellCentre(cell)))));
    float area = float(surfelSums.words[sideBase(surfel, side) + 3]) * pow(cubed, 2.0 / 3.0);
    return area * float(phase == 0 ? shortRound() : phase);
}

void main() {
    uint round = bounceRounds.state.frame / shortRound(), count = voxelCounter.count * SIDES;
    BounceSums sums = BounceSums(vec3(0.0), vec3(0.0), vec3(0.0));
    for (uint i = gl_GlobalInvocationID.x; i < count; i += SUM_GROUPS * SUM_THREADS) {
        SideLight g = sideLightOf(sideGathered.list[i]);
        uint surfel = i / SIDES, side = i % SIDES;
        if (axisOfSurfel(surfel) < 0 || g.updates != round) continue;
        vec3 light = weightOf(surfel, side) * g.light;
        vec3 reflected = sideOfSurfel(surfel, side).color * light;
        sums = plus(sums, BounceSums(light, (1.0 - g.first) * light, reflected));
    }
    sums = groupSum(sums);
    if (gl_LocalInvocationIndex == 0) bouncePartials.list[gl_WorkGroupID.x] = sums;
}
