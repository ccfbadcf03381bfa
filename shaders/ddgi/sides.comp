#version 460
#extension GL_GOOGLE_include_directive : require
// Light of the surfels' sides by the probes of the last frame. Injection reflects it.
#include "params.glsl"
#include "volume/volume.glsl"
#include "surfels/sides.glsl"
#include "surfels/place.glsl"
#include "ddgi/lookup.glsl"

layout(local_size_x = 128) in;

void main() {
    for (uint i = gl_GlobalInvocationID.x; i < voxelCounter.count * SIDES;
            i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        uint surfel = i / SIDES, side = i % SIDES;
        if (axisOfSurfel(surfel) < 0) continue;
        ivec3 cell = cellOfSurfel(surfel);
        Side s = sideOfSurfel(surfel, side);
        vec3 light = vec3(0.0);
        if (s.normal != vec3(0.0)) {
            vec3 p = surfelPosition(volume.maps[cascadeOf(cell)], cell, surfelBase(surfel), side,
                uint(axisOfSurfel(surfel)));
            light = probeLightAt(p, s.normal, s.normal).rgb;
        }
        sideGathered.list[i] = packLight(light, 0.0);
    }
}
