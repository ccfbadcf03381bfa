#version 460
#extension GL_GOOGLE_include_directive : require
// The voxel view: a cube of 36 vertices for each slot of the voxel list, enlarged to its cell of the chosen
// level (slots that share one draw it again; the depth test drops them).
#include "params.glsl"
#include "scene.glsl"
#include "volume.glsl"
#include "voxels.glsl"

layout(location = 0) flat out vec4 color;
layout(location = 1) out vec3 position;

uniform sampler3D voxelColor;
uniform sampler3D voxelNormal;
uniform sampler3D voxelRadiance;

vec4 cellColor(ivec3 cell, ivec3 coarse, int mip) {
    if (params.voxel_view == VOXEL_VIEW_RADIANCE) {
        vec4 r = texelFetch(voxelRadiance, coarse, mip);
        return vec4(r.rgb / max(r.a, 1e-4), r.a);
    }
    if (params.voxel_view == VOXEL_VIEW_ALPHA) return vec4(vec3(texelFetch(voxelRadiance, coarse, mip).a), 1.0);
    if (params.voxel_view == VOXEL_VIEW_NORMAL) return vec4(texelFetch(voxelNormal, cell, 0).rgb, 1.0);
    if (params.voxel_view == VOXEL_VIEW_DENSITY) return vec4(densityColor(volume.grid, volumeToWorld(volume.grid, (vec3(cell) + 0.5) / float(params.voxel_dim))), 1.0);
    return vec4(texelFetch(voxelColor, cell, 0).rgb, 1.0);
}

void main() {
    const int corners[6] = int[6](0, 1, 2, 2, 1, 3);
    ivec3 cell = cellOfSlot(gl_InstanceIndex);
    bool filtered = params.voxel_view == VOXEL_VIEW_RADIANCE || params.voxel_view == VOXEL_VIEW_ALPHA;
    int mip = filtered ? min(params.voxel_view_mip, textureQueryLevels(voxelRadiance) - 1) : 0;
    ivec3 coarse = cell >> mip;
    int face = gl_VertexIndex / 6, corner = corners[gl_VertexIndex % 6];
    vec3 at = vec3(float(corner & 1), float(corner >> 1), float(face & 1));
    at = face < 2 ? at.zxy : face < 4 ? at.yzx : at.xyz;
    vec3 u = (vec3(coarse) + at) * float(1 << mip) / float(params.voxel_dim);
    position = volumeToWorld(volume.grid, u);
    color = cellColor(cell, coarse, mip);
    gl_Position = camera.view_projection * vec4(position, 1.0);
}
