#version 460
#extension GL_GOOGLE_include_directive : require
// Marks the probes that a surface may look up: those of the grid's cells within a voxel of a surfel.
#include "params.glsl"
#include "volume/volume.glsl"
#include "surfels/surfels.glsl"
#include "ddgi/probes.glsl"

layout(local_size_x = 128) in;

layout(std430) writeonly buffer ProbeNeeded { uint list[]; } probeNeeded;

void main() {
    uint surfel = gl_GlobalInvocationID.x;
    if (surfel >= voxelCounter.count || axisOfSurfel(surfel) < 0) return;
    ivec3 cell = cellOfSurfel(surfel);
    VolumeMap map = volume.maps[cascadeOf(cell)];
    vec3 p = volumeToWorld(map, cellCentre(cell));
    vec3 reach = cellSize(map, p) + lookupOffset();
    ivec3 last = probeGrid() - 1;
    ivec3 low = clamp(ivec3(floor(inProbes(p - reach))), ivec3(0), last),
        high = clamp(ivec3(floor(inProbes(p + reach))) + 1, ivec3(0), last);
    for (int z = low.z; z <= high.z; z++)
        for (int y = low.y; y <= high.y; y++)
            for (int x = low.x; x <= high.x; x++) probeNeeded.list[probeIndex(ivec3(x, y, z))] = 1;
}
