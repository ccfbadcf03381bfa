#version 460
#extension GL_GOOGLE_include_directive : require
// Adds the light that a texel of a reflective shadow map reflects to its cell in each grid, and the
// texel's surface to the blockers; pass.index is the view.
#include "params.glsl"
#include "lights/lights.glsl"
#include "shadow/views.glsl"
#include "lpv/blockers.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

uniform sampler2DArray rsmFlux;
uniform sampler2DArray rsmNormal;
uniform sampler2DArray rsmDepth;

layout(std430) buffer LpvInjected { uint words[]; } lpvInjected; // 64-bit sums: low, high

void addLight(uint number, float light) {
    float scaled = light * LIGHT_UNIT;
    bool negative = scaled < 0.0;
    scaled = min(abs(scaled), 1e18); // far from the end of the 64 bits
    uint high = uint(scaled / 4294967296.0), low = uint(scaled - float(high) * 4294967296.0);
    if (negative) { // two's complement
        high = ~high + (low == 0u ? 1u : 0u);
        low = ~low + 1u;
    }
    uint before = atomicAdd(lpvInjected.words[2 * number], low);
    if (before + low < before) high++;
    if (high != 0u) atomicAdd(lpvInjected.words[2 * number + 1], high);
}

void main() {
    ivec3 texel = ivec3(gl_GlobalInvocationID.xy, pass.index);
    if (any(greaterThanEqual(texel.xy, ivec2(params.rsm_dim)))) return;
    float depth = texelFetch(rsmDepth, texel, 0).r;
    if (depth >= 1.0) return;
    ShadowView view = shadowViews.views[pass.index];
    Light light = lights.lights[view.light];
    vec2 clip = (vec2(texel.xy) + 0.5) / float(params.rsm_dim) * 2.0 - 1.0;
    vec4 h = view.inverse_view_projection * vec4(clip, depth, 1.0);
    vec3 p = h.xyz / h.w, n = fromOctahedral(texelFetch(rsmNormal, texel, 0).rg);
    float across = mapArea(view) / float(params.rsm_dim * params.rsm_dim);
    vec3 flux = texelFetch(rsmFlux, texel, 0).rgb * across;
    if (LPV_BLOCKING == LPV_BLOCKING_ON) {
        vec3 off = p - light.position;
        // Area of the texel across the ray. It is a little too large at the corners of the view.
        float area = across * (view.texel_size_and_depth.z > 0.0 ? dot(off, off) : 1.0);
        addBlocker(p, n, area / max(dot(n, incidentLight(light, p).to_light), 0.1), 0);
    }
    for (int grid = 0; grid < params.lpv_cascades; grid++) {
        float cell = cellEdge(grid);
        // Half a cell off the surface, so that it neither lights nor blocks itself.
        ivec3 at = ivec3(floor((p - gridCorner(grid)) / cell + 0.5 * n));
        if (!inGrid(at)) continue;
        vec4 lobe = cosineLobe(n) / (PI * cell * cell);
        for (int i = 0; i < 12; i++) {
            float value = flux[i / 4] * lobe[i % 4];
            if (value != 0.0) addLight(12u * indexIn(params.lpv_dim, at, grid) + uint(i), value);
        }
    }
}
