#version 460
#extension GL_GOOGLE_include_directive : require
// Keeps where the volume lay, for the next frame's look into the history.
#include "params.glsl"
#include "volume.glsl"
#include "voxels.glsl"

layout(local_size_x = 1) in;

layout(std430) buffer LastVolume { Grid grids[MAX_BLOCKS]; uint frames; uint signature; } lastVolume;

void main() {
    lastVolume.grids = volume.grids;
    lastVolume.signature = voxelCounter.signature;
    lastVolume.frames = min(lastVolume.frames, 0xfffffffeu) + 1;
}
