#version 460
#extension GL_GOOGLE_include_directive : require
// Resolves sums to means over all surfaces of a cell, for views and inspection: voxelColor (mean base colour,
// opacity) and voxelNormal (direction * 0.5 + 0.5; alpha: length of the mean normal, 1 if all agree, 0 if
// they cancel).
#include "params.glsl"
#include "volume/volume.glsl"
#include "voxels/bricks.glsl"

layout(local_size_x = 128) in;

uniform writeonly image3D voxelColor;
uniform writeonly image3D voxelNormal;

#include "modules/merge.glsl"
void main() {
    uint surfel = gl_GlobalInvocationID.x;
    if (surfel >= voxelCounter.count || axisOfSurfel(surfel) < 0) return;
    ivec3 cell = cellOfSurfel(surfel);
    uint found = foundAtStored(cell);
    if (surfel != firstSurfel(found)) return;
    vec3 color = vec3(0.0), normal = vec3(0.0);
    float count = 0.0;
    for (uint i = 0; i < surfelCount(found) * SIDES; i++) {
        uint base = sideBase(surfel + i / SIDES, i % SIDES);
        float weight = float(surfelSums.words[base + 3]);
        if (weight == 0.0) continue;
        vec3 c, n;
        mergedMean(base, c, n);
        color += weight * c;
        normal += weight * n;
        count += weight;
    }
    if (count == 0.0) return; // all surfaces were cut out
    color /= count;
    normal /= count;
    float agreement = length(normal);
    vec3 direction = agreement > 1e-3 ? normal / agreement : vec3(0.0);
    imageStore(voxelColor, cell, vec4(color, 1.0));
    imageStore(voxelNormal, cell, vec4(direction * 0.5 + 0.5, min(agreement, 1.0)));
}
