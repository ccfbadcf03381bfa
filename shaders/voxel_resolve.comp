#version 460
#extension GL_GOOGLE_include_directive : require
// Sums to means: voxelColor (mean base colour, opacity) and voxelNormal (direction * .5 + .5; alpha is the
// length of the mean normal, 1 where all agree and 0 where they cancel).
#include "params.glsl"
#include "volume.glsl"
#include "voxels.glsl"

layout(local_size_x = 128) in;

uniform writeonly image3D voxelColor;
uniform writeonly image3D voxelNormal;

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= voxelCounter.count) return;
    ivec3 cell = cellOfSlot(slot);
    uint base = slot * SLOT_WORDS;
    vec3 color, normal;
    if (MERGE == MERGE_AVERAGE) {
        float count = float(max(voxelSlots.words[base + 3], 1u));
        color = vec3(voxelSlots.words[base], voxelSlots.words[base + 1], voxelSlots.words[base + 2]) / (COLOR_SCALE * count);
        normal = vec3(int(voxelSlots.words[base + 4]), int(voxelSlots.words[base + 5]), int(voxelSlots.words[base + 6])) / (NORMAL_SCALE * count);
    } else {
        color = unpackUnorm4x8(voxelSlots.words[base]).rgb;
        normal = unpackUnorm4x8(voxelSlots.words[base + 4]).rgb * 2.0 - 1.0;
    }
    float agreement = length(normal);
    vec3 direction = agreement > 1e-3 ? normal / agreement : vec3(0.0);
    imageStore(voxelColor, cell, vec4(color, params.voxel_opacity));
    imageStore(voxelNormal, cell, vec4(direction * 0.5 + 0.5, min(agreement, 1.0)));
}
