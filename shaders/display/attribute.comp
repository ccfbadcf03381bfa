#version 460
#extension GL_GOOGLE_include_directive : require
// Attribute that colours the cubes of the voxel view, if the voxels have it at one level only. Premultiplied
// by opacity, so that filter/isotropic.comp can compute the other levels.
#include "params.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;

uniform sampler3D voxelColor;
uniform sampler3D voxelNormal;
uniform writeonly image3D shown;

void main() {
    ivec3 cell = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(cell, imageSize(shown)))) return;
    vec4 color = texelFetch(voxelColor, cell, 0);
    vec3 value = params.voxel_view == VOXEL_VIEW_NORMAL ?
        texelFetch(voxelNormal, cell, 0).rgb * 2.0 - 1.0 : color.rgb;
    imageStore(shown, cell, vec4(value * color.a, color.a));
}
