#version 460
#extension GL_GOOGLE_include_directive : require
// Radiance injection from the shadow maps (thesis, Section 4.3 and Algorithm 2). One thread per texel writes
// the voxel that the texel hits. As in the thesis, it writes the base colour instead of the reflected light,
// at the texel's corner instead of its centre. Writes of several texels and lights race: the last one stays.
#include "params.glsl"
#include "volume/volume.glsl"
#include "shadow/views.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

uniform sampler2DArray shadowMap;
uniform sampler3D voxelColor;
uniform writeonly image3D injected;

void inject(ivec3 cell) {
    vec4 color = texelFetch(voxelColor, cell, 0);
    if (color.a == 0.0) return;
    imageStore(injected, cell, vec4(color.rgb * color.a, color.a));
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, ivec2(params.shadow_dim)))) return;
    float depth = texelFetch(shadowMap, ivec3(texel, pass.index), 0).r;
    if (depth >= 1.0) return;
    ShadowView view = shadowViews.views[pass.index];
    vec2 at = vec2(texel) / float(params.shadow_dim);
    vec4 h = view.inverse_view_projection * vec4(at * 2.0 - 1.0, depth, 1.0);
    vec3 p = h.xyz / h.w;
    for (int cascade = 0; cascade < CASCADE_COUNT; cascade++) {
        ivec3 cell = ivec3(floor(worldToVolume(volume.maps[cascade], p) * float(params.voxel_dim)));
        if (inGrid(cell)) inject(storedCell(cell, cascade));
    }
}
