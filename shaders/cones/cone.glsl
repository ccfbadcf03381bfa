// Voxel cone tracing (thesis, Section 4.5.2): a march in world space with lengths in local level-0 cells, so that it is the
// same under every warp. Where samples lie and what they read: modules/lookup. How much of a cone a step hides:
// modules/opacity.
#ifndef CONE_GLSL
#define CONE_GLSL
#include "modules/lookup.glsl"
#include "cones/near.glsl"

// A cone that has met more than stop_transmittance leaves: what is left would hit something too, so it is spread over what
// was hit.
vec4 stopped(vec3 color, float alpha) {
    return vec4(color / alpha, 1.0);
}

// Mean radiance (premultiplied) and opacity along a cone. tan_half: tangent of half the aperture.
vec4 traceCone(ConeOrigin o, vec3 d, float tan_half, int steps) {
    float first_cell;
    Cone cone = coneFrom(o, d, tan_half, first_cell);
    float along = params.cone_height * first_cell;
    if (params.near_cells > 0.0 && meetsPlanes(o)) {
        float range = params.near_cells * first_cell;
        Met met = meetSurface(o, d, range);
        if (met.light.a > 0.0) {
            vec3 position = o.surface + met.distance * d;
            CONE_SAMPLED(0, met.distance, ConeSample(position, met.distance * tan_half, 0.0, first_cell, first_cell, 0.0, met.light, false, true), 1.0, 0.0);
            return met.light;
        }
        along = max(met.distance, min(along, range));
    }
    vec3 color = vec3(0.0);
    float alpha = 0.0;
    for (int i = 0; i < steps; i++) {
        ConeSample x = coneSample(cone, i, along);
        if (x.outside) break;
        float a = 0.0;
        if (x.texel.a > 1e-5) {
            a = stepAlpha(x.texel.a, 1.0 - alpha, x.advance, x.voxel, x.cell);
            color += x.texel.rgb * (a / x.texel.a);
            alpha += a;
            if (1.0 - alpha < params.stop_transmittance) {
                CONE_SAMPLED(i, along, x, a, 1.0 - alpha);
                return stopped(color, alpha);
            }
        }
        CONE_SAMPLED(i, along, x, a, 1.0 - alpha);
        if (x.last) break;
        along += x.advance;
    }
    return vec4(color, min(alpha, 1.0));
}

#endif
