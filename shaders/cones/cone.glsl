// Voxel cone tracing (thesis, Section 4.5.2): marches in world space, with lengths in local level-0 cells, so
// that warps do not change it. cones/lookup.glsl places and reads the samples, modules/opacity computes the
// opacity of a step.
#ifndef CONE_GLSL
#define CONE_GLSL
#include "cones/cone_origin.glsl"
#include "cones/lookup.glsl"
#include "surfels/trace.glsl"
#include "gather/emitters.glsl"

// Ends a cone with its transmittance below stop_transmittance. The rest would hit something too, so the
// result is normalised to full opacity.
vec4 stopped(vec3 color, float alpha) {
    return vec4(color / alpha, 1.0);
}

// Length of the exact part of a cone [m]. Up to there the cone is at most 2^-lod_offset cells wide and would
// read level 0, so its axis is traced against surfels instead. Interleaved cones measure this in the cells
// of the coarsest cascade, the largest. Warped cells bend rays, so their exact part is near_cells long.
// near_cells = 0: no part is exact.
float exactRange(ConeOrigin o, vec3 d, float tan_half) {
    float near = params.near_cells * cellLength(volume.maps[o.cascade], o.surface, d);
    if (WARPED || params.near_cells == 0.0) return near;
    float cell = cellLength(volume.maps[INTERLEAVED_CONES ? CASCADE_COUNT - 1 : o.cascade], o.surface, d);
    return max(near, exp2(-params.lod_offset) * cell / (2.0 * tan_half));
}

// Mean radiance (premultiplied) and opacity along a cone. tan_half: tangent of half the aperture. Rays to
// emitter samples are exact along their whole length, because filtered levels blur the shadows of lamps.
vec4 traceCone(ConeOrigin o, vec3 d, float tan_half, int steps, RayUse use) {
    float first_cell;
    Cone cone = coneFrom(o, d, tan_half, first_cell);
    float along = params.cone_height * first_cell;
    bool to_emitter = use.range < 1e30;
    float range = to_emitter ? use.range : exactRange(o, d, tan_half);
    if ((range > 0.0 || to_emitter) && hasSurfels(o)) {
        SurfelHit met = traceSurfels(o, d, range);
        if (met.emitted > 0.5 && met.distance > use.lamp) met.light = vec4(0.0);
        if (to_emitter) return met.light;
        if (met.light.a > 0.0) {
            met.light.rgb *= shareOfRay(use, met.light.rgb, met.emitted, met.distance);
            vec3 position = o.surface + met.distance * d;
            CONE_SAMPLED(0, met.distance,
                ConeSample(position, met.distance * tan_half, 0.0, first_cell, first_cell, 0.0, met.light,
                    false, true),
                1.0, 0.0);
            return met.light;
        }
        // On a miss the cone continues where the ray ended. The ray starts at o.surface, the cone at
        // o.position, which is almost `bias` cells higher.
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

vec4 traceCone(ConeOrigin o, vec3 d, float tan_half, int steps) {
    return traceCone(o, d, tan_half, steps, WHOLE_RAY);
}

#endif
