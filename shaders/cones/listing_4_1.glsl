// Cone tracing as in Listing 4.1 of the thesis: starts `bias` voxels along the shading normal, reads the
// level as wide as the cone, uses opacity as stored, and steps by the cone's radius. Lengths are in world
// units; the listing's are in voxels. Additions: a cone ends at the volume's border (the listing reads on
// through zeros), a step is at least 0.05 voxels, and nearly transparent texels add nothing.
#ifndef CONE_GLSL
#define CONE_GLSL
#include "cones/origin.glsl"
#include "modules/mips.glsl"
#include "cones/level.glsl"
#include "cones/sample.glsl"

// The shading normal can point into the geometry.
ConeOrigin coneOrigin(vec3 p, vec3 geometric, vec3 shading) {
    return ConeOrigin(p + params.bias * cellLength(volume.maps[0], p, shading) * shading, geometric, 0.0, 0.0,
        0, vec3(0.0), 1.0);
}

// Radiance (premultiplied) and opacity along a cone. tan_half: tangent of half the aperture.
vec4 traceCone(ConeOrigin o, vec3 d, float tan_half, int steps) {
    VolumeMap map = volume.maps[0];
    float voxel = cellLength(map, o.position, d);
    float along = params.cone_height * voxel;
    vec3 color = vec3(0.0);
    float alpha = 0.0;
    for (int i = 0; i < steps; i++) {
        float radius = along * tan_half;
        float level = clamp(coneLevel(voxel, radius), 0.0, map.last);
        vec3 p = o.position + along * d;
        vec3 u = worldToVolume(map, p);
        if (!inVolume(u)) break;
        vec4 texel = sampleLevel(u, d, level);
        float a = texel.a > 1e-5 ? (1.0 - alpha) * texel.a : 0.0, advance = max(radius, 0.05 * voxel);
        if (a > 0.0) color += texel.rgb * (a / texel.a);
        alpha += a;
        CONE_SAMPLED(i, along,
            ConeSample(p, radius, level, voxel, voxel * exp2(level), advance, texel, false, false),
            a, 1.0 - alpha);
        if (1.0 - alpha < params.stop_transmittance) break;
        along += advance;
    }
    return vec4(color, min(alpha, 1.0));
}

#endif
