#version 460
#extension GL_GOOGLE_include_directive : require
// Blends last frame's radiance into this frame's (thesis, Section 4.7.2). Looks it up at the cell's position
// in last frame's volume, so that a moving volume does not smear. The history is rgba16f: with 8 bits the
// decay would stall.
#include "params.glsl"
#include "volume/volume.glsl"
#include "voxels/voxels.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;

uniform sampler3D voxelLight; // this frame's
uniform sampler3D lastHistory;
layout(std430) readonly buffer LastVolume { VolumeMap maps[MAX_CASCADES]; uint signature; } lastVolume;
uniform writeonly image3D voxelHistory;
uniform writeonly image3D voxelRadiance;

// A camera that moves more than temporal_cut counts as a cut. It may not have seen this volume before, or
// only from farther away.
bool isCut(VolumeMap g, VolumeMap last) {
    return distance(g.seen_from, last.seen_from) > params.temporal_cut;
}

void main() {
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(texel, imageSize(voxelHistory)))) return;
    int face = texel.x / params.voxel_dim;
    ivec3 cell = ivec3(texel.x - face * params.voxel_dim, texel.yz);
    int cascade = cascadeOf(cell);
    vec4 value = texelFetch(voxelLight, texel, 0);
    VolumeMap g = volume.maps[cascade], last = lastVolume.maps[cascade];
    if (lastVolume.signature == volume.signature && !isCut(g, last)) {
        vec3 u = worldToVolume(last, volumeToWorld(g, cellCentre(cell)));
        // After a move by whole voxels, the lookup hits a cell centre up to rounding.
        if (inVolume(u)) {
            float half_cell = 0.5 / float(params.voxel_dim);
            u.x = (float(face) + clamp(u.x, half_cell, 1.0 - half_cell)) / float(params.radiance_faces);
            u.z = (float(cascade) + clamp(u.z, half_cell, 1.0 - half_cell)) / float(CASCADE_COUNT);
            value = mix(value, textureLod(lastHistory, u, 0.0), params.temporal_factor);
        }
    }
    // Ends the tail: half floats decay slowly near 0.
    value = mix(vec4(0.0), value, greaterThan(value, vec4(1e-6)));
    imageStore(voxelHistory, texel, value);
    imageStore(voxelRadiance, texel, value);
}
