#version 460
#extension GL_GOOGLE_include_directive : require
// Sums to means: voxelColor (mean base colour, opacity) and voxelNormal (direction * .5 + .5; alpha is the
// length of the mean normal, 1 where all agree and 0 where they cancel).
#include "params.glsl"
#include "common/volume.glsl"
#include "common/voxels.glsl"

layout(local_size_x = 128) in;

uniform writeonly image3D voxelColor;
uniform writeonly image3D voxelNormal;

#include "modules/merge.glsl"

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= voxelCounter.count) return;
    ivec3 cell = cellOfSlot(slot);
    uint base = slot * SLOT_WORDS;
    vec3 color, normal;
    mergedMean(base, color, normal);
    float agreement = length(normal);
    vec3 direction = agreement > 1e-3 ? normal / agreement : vec3(0.0);
    imageStore(voxelColor, cell, vec4(color, 1.0));
    imageStore(voxelNormal, cell, vec4(direction * 0.5 + 0.5, min(agreement, 1.0)));
}
