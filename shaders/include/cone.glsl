// Voxel cone tracing (thesis, Section 4.5.2 and Listing 4.1). The march runs in world space with lengths
// in local level-0 cells, so it is the same under every warp. With opacity "stored", step "radius" and no
// clearance it is the thesis's listing to the letter. With CONE_RECORD defined, recordSample is called for
// each sample.
#ifndef CONE_GLSL
#define CONE_GLSL
#include "cone_origin.glsl"
#include "faces.glsl"

uniform sampler3D voxelFaces; // levels 1 and up, by direction; unused unless DIRECTIONAL

// Between blocks and at their borders a lookup keeps half a cell of its level's distance. `u` in a block's coordinates.
vec3 stacked(vec3 u, int block, float lod) {
    if (BLOCKS == 1) return u;
    float margin = 0.5 * exp2(ceil(max(lod, 0.0))) / float(params.voxel_dim);
    return vec3(u.xy, (float(block) + clamp(u.z, margin, 1.0 - margin)) / float(BLOCKS));
}

// The voxels around u as a cone along d (unit length, in cells) finds them at a level of a block.
vec4 sampleCone(vec3 u, int block, vec3 d, float lod) {
    u = stacked(u, block, lod);
    if (!DIRECTIONAL) return textureLod(voxelRadiance, u, lod);
    vec4 fine = vec4(0.0);
    if (lod < 1.0) fine = textureLod(voxelRadiance, u, 0.0);
    if (lod <= 0.0) return fine;
    vec3 w = OPACITY == OPACITY_COVERAGE ? abs(d) : d * d;
    vec4 faces = sampleFaces(voxelFaces, u, d, w, max(lod - 1.0, 0.0), float(textureSize(voxelFaces, 0).y));
    return lod < 1.0 ? mix(fine, faces, lod) : faces;
}

// The level whose cells are as wide as the cone. `v`: length of the block's cell along the cone, `height`: above the
// plane of the surface that the cone leaves [m].
float levelAt(Grid g, int block, vec3 p, float v, float radius, float height, ConeOrigin o) {
    float lod = log2(max(2.0 * radius / v, 1.0)) + params.lod_offset;
    if (params.lod_clearance) {
        // A trilinear lookup reads 1.5 cells to each side. Coarser levels than fit above the surface
        // would read the surface itself, and an open plane would shadow itself. Whole levels, because
        // a fraction would blend in the coarser one.
        float reach = WARP == WARP_NONE && BLOCKS == 1 ? o.reach : cellReach(g, p, o.normal);
        // Cells of a warp that grow towards the surface reach it sooner than those around the sample say.
        if (WARP != WARP_NONE && block == o.block) reach = max(reach, o.reach);
        lod = min(lod, floor(log2(max(height / (3.0 * reach), 1.0)) + 1e-3));
    }
    return clamp(lod, 0.0, g.last);
}

// Lookups of a sample: its block; round a spherical block's seam, where the first cells follow the last, the other side;
// towards a block's border the next block. One place for all of them: the compiler copies it for every kind of cone.
const int OWN = 0, SEAM = 1, NEXT = 2;

// Mean radiance (premultiplied) and opacity along a cone. tan_half: tangent of half the aperture.
vec4 traceCone(ConeOrigin o, vec3 d, float tan_half, int steps) {
    int block = o.block;
    float v0, v;
    vec3 way;
    cellAlong(volume.grids[block], o.position, d, v, way);
    v0 = BLOCKS > 1 && o.share < 1.0 ? mix(cellLength(volume.grids[block + 1], o.position, d), v, o.share) : v;
    float rise = max(dot(d, o.normal), 0.0);
    float s = params.cone_height * v0;
    vec3 color = vec3(0.0);
    float alpha = 0.0;
    for (int i = 0; i < steps; i++) {
        vec3 p = o.position + s * d;
        int before = block;
        if (BLOCKS > 1) block = blockAt(p);
        float radius = s * tan_half, height = o.height + s * rise;
        float lod, cell, ds, share = 1.0, seam = 0.0;
        bool outside = false;
        vec4 texel = vec4(0.0);
        for (int lookup = OWN; lookup <= NEXT; lookup++) {
            if (lookup == SEAM && seam <= 0.0) continue;
            if (lookup == NEXT && share >= 1.0) break;
            int k = lookup == NEXT ? block + 1 : block;
            Grid g = volume.grids[k];
            vec3 u = worldToVolume(g, p);
            if (lookup == OWN) {
                // Past the border the clamped lookup gives the border cells once more: a coarse cell that holds the
                // outermost wall reaches to the border, and stopping short of it would let light out.
                outside = !inVolume(u);
                if (outside && (i == 0 || block != before || CURVED && g.curved != 0 || OPACITY == OPACITY_STORED)) return vec4(color, min(alpha, 1.0));
            } else if (lookup == NEXT && !inVolume(u)) {
                break;
            }
            float own = v;
            if (WARP != WARP_NONE || BLOCKS > 1) cellAlong(g, p, d, own, way);
            float level = levelAt(g, k, p, own, radius, height, o);
            float size = own * exp2(level);
            if (lookup == OWN) {
                v = own;
                lod = level;
                cell = size;
                ds = max(CONE_STEP == CONE_STEP_RADIUS ? radius : params.step_factor * cell, 0.05 * v);
                if (BLOCKS > 1 && block < BLOCKS - 1) share = shareOfBlock(u, lod);
            }
            if (WARP == WARP_SPHERICAL && k == 0) {
                float half_cell = 0.5 * exp2(level) / float(params.voxel_dim);
                seam = max(half_cell - u.x, u.x - 1.0 + half_cell) / (2.0 * half_cell);
                u.x = lookup == OWN ? clamp(u.x, half_cell, 1.0 - half_cell) : u.x < 0.5 ? 1.0 - half_cell : half_cell;
            }
            vec4 found = sampleCone(u, k, way, level);
            if (lookup == OWN) {
                texel = found;
            } else if (lookup == SEAM) {
                texel = mix(texel, found, seam);
            } else {
                // Of surfaces side by side opacity is a density, of layers one for each voxel: the step is told in the
                // first block's cells.
                if (OPACITY == OPACITY_COVERAGE) found *= DIRECTIONAL ? cell / size : v / own;
                else if (OPACITY == OPACITY_LAYERS && found.a > 0.0) found *= (1.0 - pow(1.0 - min(found.a, 1.0), v / own)) / found.a;
                texel = mix(found, texel, share);
            }
        }
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
