// Voxel cone tracing (thesis, Section 4.5.2 and Listing 4.1). The march runs in world space with lengths
// in local level-0 cells, so it is the same under every warp. With opacity "stored", step "radius" and no
// clearance it is the thesis's listing to the letter. With CONE_RECORD defined, recordSample is called for
// each sample.
#ifndef CONE_GLSL
#define CONE_GLSL
#include "cone_origin.glsl"
#include "faces.glsl"

uniform sampler3D voxelFaces; // levels 1 and up, by direction; unused unless DIRECTIONAL

// The voxels around u as a cone along d (unit length, in cells) finds them at a level.
vec4 sampleCone(vec3 u, vec3 d, float lod) {
    if (!DIRECTIONAL) return textureLod(voxelRadiance, u, lod);
    float cells = float(textureSize(voxelFaces, 0).y);
    vec3 w = OPACITY == OPACITY_COVERAGE ? abs(d) : d * d;
    if (lod >= 1.0) return sampleFaces(voxelFaces, u, d, w, lod - 1.0, cells);
    vec4 fine = textureLod(voxelRadiance, u, 0.0);
    return lod <= 0.0 ? fine : mix(fine, sampleFaces(voxelFaces, u, d, w, 0.0, cells), lod);
}

// Mean radiance (premultiplied) and opacity along a cone. tan_half: tangent of half the aperture.
vec4 traceCone(ConeOrigin o, vec3 d, float tan_half, int steps) {
    Grid g = volume.grid;
    // Blocks of faces are level beside level as long as their sizes halve.
    float last = float(DIRECTIONAL ? min(params.voxel_mips - 1, findLSB(params.voxel_dim)) : textureQueryLevels(voxelRadiance) - 1);
    float v0 = cellAlong(g, o.position, d), v = v0;
    vec3 way = gridDirection(g, o.position, d);
    float rise = max(dot(d, o.normal), 0.0);
    float s = params.cone_height * v0;
    vec3 color = vec3(0.0);
    float alpha = 0.0;
    for (int i = 0; i < steps; i++) {
        vec3 p = o.position + s * d;
        vec3 u = worldToVolume(g, p);
        // Past the border the clamped lookup gives the border cells once more: a coarse cell that holds the
        // outermost wall reaches to the border, and stopping short of it would let light out.
        bool outside = !inVolume(u);
        if (outside && (i == 0 || WARP == WARP_PERSPECTIVE || OPACITY == OPACITY_STORED)) break;
        if (WARP != WARP_NONE) {
            v = cellAlong(g, p, d);
            way = gridDirection(g, p, d);
        }
        float radius = s * tan_half;
        float lod = log2(max(2.0 * radius / v, 1.0)) + params.lod_offset;
        if (params.lod_clearance) {
            // A trilinear lookup reads 1.5 cells to each side. Coarser levels than fit above the surface
            // would read the surface itself, and an open plane would shadow itself. Whole levels, because
            // a fraction would blend in the coarser one.
            float cells = (o.height + s * rise) * v0 / (3.0 * o.reach * v);
            lod = min(lod, floor(log2(max(cells, 1.0)) + 1e-3));
        }
        lod = clamp(lod, 0.0, last);
        float cell = v * exp2(lod);
        float ds = max(CONE_STEP == CONE_STEP_RADIUS ? radius : params.step_factor * cell, 0.05 * v);

        vec4 texel = sampleCone(u, way, lod);
        if (texel.a > 1e-5) {
            float remaining = 1.0 - alpha;
            float a;
            // Layers: a mean opacity belongs to a voxel, and a step crosses ds / v of them, one behind the other.
            if (OPACITY == OPACITY_LAYERS) a = remaining * (1.0 - pow(1.0 - min(texel.a, 1.0), ds / v));
            // Coverage: surfaces one voxel thick that fill this share of the volume cover this much of the
            // cone, side by side. Thin walls stay closed at every level; corners darken too much.
            else if (OPACITY == OPACITY_COVERAGE) a = min(texel.a * ds / (DIRECTIONAL ? cell : v), remaining);
            // Cell: one layer a mip cell, corrected for the step alone; thin walls leak.
            else if (OPACITY == OPACITY_CELL) a = remaining * (1.0 - pow(1.0 - min(texel.a, 1.0), ds / cell));
            else a = remaining * texel.a;
            color += texel.rgb * (a / texel.a);
            alpha += a;
#ifdef CONE_RECORD
            recordSample(i, p, s, ds, radius, lod, cell, texel, a, 1.0 - alpha);
#endif
            if (1.0 - alpha < params.stop_transmittance) {
                // What is left would hit something too: spread it over what was hit.
                if (params.cone_renormalize) return vec4(color / alpha, 1.0);
                break;
            }
        }
#ifdef CONE_RECORD
        else recordSample(i, p, s, ds, radius, lod, cell, texel, 0.0, 1.0 - alpha);
#endif
        if (outside) break;
        s += ds;
    }
    return vec4(color, min(alpha, 1.0));
}

#endif
