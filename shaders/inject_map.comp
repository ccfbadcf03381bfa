#version 460
#extension GL_GOOGLE_include_directive : require
// Radiance injection from the shadow maps (thesis, Section 4.3 and Algorithm 2): one thread a texel writes
// into the voxel it hits. Writes of several texels, and of several lights, race: the last one stays.
#include "params.glsl"
#include "volume.glsl"
#include "shadow_views.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

uniform sampler2DArray shadowMap;
uniform sampler3D voxelColor;
uniform sampler3D voxelNormal;
uniform writeonly image3D injected;

const float PI = 3.14159265359;

void inject(ivec3 cell, Light light, vec3 p) {
    vec4 color = texelFetch(voxelColor, cell, 0);
    if (color.a == 0.0) return;
    vec3 radiance = color.rgb;
    if (params.inject_shading == INJECT_SHADING_LIT) {
        Incident incident = incidentLight(light, p);
        vec3 n = texelFetch(voxelNormal, cell, 0).rgb * 2.0 - 1.0;
        n = dot(n, n) > 0.25 ? normalize(n) : incident.to_light;
        radiance *= incident.irradiance * max(dot(n, incident.to_light), 0.0) / PI;
    }
    imageStore(injected, cell, vec4(radiance * color.a, color.a));
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, ivec2(params.shadow_dim)))) return;
    float depth = texelFetch(shadowMap, ivec3(texel, pass.index), 0).r;
    if (depth >= 1.0) return;
    ShadowView view = shadowViews.views[pass.index];
    vec2 at = (vec2(texel) + (params.inject_half_texel ? 0.5 : 0.0)) / float(params.shadow_dim);
    vec4 h = view.inverse_view_projection * vec4(at * 2.0 - 1.0, depth, 1.0);
    vec3 p = h.xyz / h.w;
    for (int block = 0; block < BLOCKS; block++) {
        ivec3 cell = ivec3(floor(worldToVolume(volume.grids[block], p) * float(params.voxel_dim)));
        if (inGrid(cell)) inject(storedCell(cell, block), lights.lights[view.light], p);
    }
}
