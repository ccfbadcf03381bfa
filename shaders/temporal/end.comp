#version 460
#extension GL_GOOGLE_include_directive : require
// Keeps where the volume lay, for the next frame's look into the history.
#include "params.glsl"
#include "common/volume.glsl"
#include "common/voxels.glsl"

layout(local_size_x = 1) in;

layout(std430) buffer LastVolume { VolumeMap maps[MAX_CASCADES]; uint frames; uint signature; } lastVolume;

void main() {
    lastVolume.maps = volume.maps;
    lastVolume.signature = voxelCounter.signature;
    lastVolume.frames = min(lastVolume.frames, 0xfffffffeu) + 1;
}
