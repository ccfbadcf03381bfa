// Lookups that stay inside their cascade.
#ifndef CASCADE_LOOKUP_GLSL
#define CASCADE_LOOKUP_GLSL
#include "cones/cascade_weight.glsl"
#include "modules/mips.glsl"

// Keeps a lookup half a cell of its level away from the seams between stored cascades.
vec4 sampleCascade(vec3 u, int cascade, vec3 dir, float level) {
    if (CASCADE_COUNT > 1) {
        float margin = 0.5 * exp2(ceil(max(level, 0.0))) / float(params.voxel_dim);
        u.z = (float(cascade) + clamp(u.z, margin, 1.0 - margin)) / float(CASCADE_COUNT);
    }
    return sampleLevel(u, dir, level);
}

// The same. At the seam of spheres, where the first cells follow the last, it blends both sides.
vec4 sampleMap(vec3 u, int cascade, vec3 dir, float level) {
    if (!CURVED_SEAM || cascade > 0) return sampleCascade(u, cascade, dir, level);
    float half_cell = 0.5 * exp2(level) / float(params.voxel_dim);
    vec4 texel = sampleCascade(vec3(clamp(u.x, half_cell, 1.0 - half_cell), u.yz), cascade, dir, level);
    float over = max(half_cell - u.x, u.x - 1.0 + half_cell) / (2.0 * half_cell);
    if (over <= 0.0) return texel;
    return mix(texel,
        sampleCascade(vec3(u.x < 0.5 ? 1.0 - half_cell : half_cell, u.yz), cascade, dir, level), over);
}

#endif
