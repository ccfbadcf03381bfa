// What cones approximate: rays through the level-0 voxels, met one by one. Costs a hundred times a cone, and says what
// of an image's error is the voxels', the cones' and the filtering's.
#ifndef EXACT_GLSL
#define EXACT_GLSL
#include "cone_origin.glsl"
#include "frame.glsl"
#include "random.glsl"

vec2 pixelCentre();

// A turn of the sample pattern for each pixel, so that few rays look like noise and not like bands.
vec2 exactShift(uint cone) {
    Random random = Random(uvec4(uvec2(pixelCentre()), cone, 0u));
    return next4(random).xy;
}

// Point i of an additive recurrence that fills the square evenly (Roberts 2018, R2).
vec2 exactPoint(int i, vec2 shift) {
    return fract(shift + float(i) * vec2(0.7548776662, 0.5698402910));
}

// Radiance and opacity along one ray. Every voxel that the ray crosses hides as much of it as its opacity says for the
// length inside. Of one block without a warp the crossings are exact (Amanatides and Woo 1987); else the ray is not straight
// in the grid, and is followed in quarters of a cell.
vec4 traceVoxels(vec3 origin, vec3 d) {
    Grid g = volume.grids[0];
    vec3 color = vec3(0.0);
    float through = 1.0;
    int dim = params.voxel_dim;
    if (WARP != WARP_NONE || BLOCKS > 1) {
        float s = 0.0;
        for (int i = 0; i < 16 * dim; i++) {
            vec3 p = origin + s * d;
            int block = blockAt(p);
            vec3 u = worldToVolume(volume.grids[block], p);
            if (!inVolume(u)) break;
            float cell = cellLength(volume.grids[block], p, d);
            vec4 texel = texelFetch(voxelRadiance, storedCell(min(ivec3(u * float(dim)), ivec3(dim - 1)), block), 0);
            if (texel.a > 1e-5) {
                float a = through * (1.0 - pow(1.0 - min(texel.a, 1.0), 0.25));
                color += texel.rgb * (a / texel.a);
                through -= a;
                if (through < 1e-3) break;
            }
            s += 0.25 * cell;
        }
        return vec4(color, 1.0 - through);
    }
    vec3 at = (origin - g.minimum) / g.cell;
    vec3 speed = d / g.cell; // cells a metre
    ivec3 cell = ivec3(floor(at));
    ivec3 way = ivec3(sign(speed));
    vec3 advance = 1.0 / max(abs(speed), 1e-20);
    vec3 next = (mix(at - vec3(cell), vec3(cell) + 1.0 - at, greaterThan(speed, vec3(0.0)))) * advance;
    float s = 0.0, per_cell = length(speed);
    for (int i = 0; i < 3 * dim && inGrid(cell); i++) {
        int axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
        vec4 texel = texelFetch(voxelRadiance, cell, 0);
        if (texel.a > 1e-5) {
            float a = through * (1.0 - pow(1.0 - min(texel.a, 1.0), (next[axis] - s) * per_cell));
            color += texel.rgb * (a / texel.a);
            through -= a;
            if (through < 1e-3) break;
        }
        s = next[axis];
        next[axis] += advance[axis];
        cell[axis] += way[axis];
    }
    return vec4(color, 1.0 - through);
}

// The mean over rays that fill a cone evenly.
vec4 traceExactCone(ConeOrigin o, vec3 d, float tan_half, uint cone) {
    mat3 frame = frameOf(d);
    float least = inversesqrt(1.0 + tan_half * tan_half);
    vec2 shift = exactShift(cone);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < params.exact_rays; i++) {
        vec2 u = exactPoint(i, shift);
        float z = mix(1.0, least, u.x), r = sqrt(max(1.0 - z * z, 0.0)), angle = 6.28318530718 * u.y;
        sum += traceVoxels(o.position, frame * vec3(r * cos(angle), r * sin(angle), z));
    }
    return sum / float(params.exact_rays);
}

#endif
