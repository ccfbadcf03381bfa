#version 460
#extension GL_GOOGLE_include_directive : require
// Takes what last frame left in its voxels out of them, once nothing needs it any more.
#include "params.glsl"
#include "voxelize/clearing.glsl"

layout(local_size_x = 128) in;

uniform writeonly image3D injected;

void main() {
    uint last = 1 - voxelCounter.half_used, cells = cellsToClear(last), stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint i = gl_GlobalInvocationID.x; i < cells; i += stride) {
        ivec3 cell = cellToClear(last, i);
        for (int face = 0; face < params.radiance_faces; face++)
            imageStore(injected, ivec3(cell.x + face * params.voxel_dim, cell.yz), vec4(0));
    }
}
