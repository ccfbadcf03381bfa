// Rays through the level-0 voxels, cell by cell: the tracer of rays.ron and of bounces. In cones.ron, many of
// them per cone (trace: cone_rays, lobe_rays) separate the error of the voxels from that of cones.
#ifndef VOXEL_RAYS_GLSL
#define VOXEL_RAYS_GLSL
#include "cones/origin.glsl"
#include "common/random.glsl"
#include "surfels/trace.glsl"
#include "cones/sample.glsl"
#include "gather/emitters.glsl"

vec2 pixelCentre();

// Random shift of the sample pattern per pixel and cone, so that few rays give noise instead of banding.
vec2 rayShift(uint cone) {
    Random random = Random(uvec4(uvec2(pixelCentre()), cone, 0u));
    return next4(random).xy;
}

// Point i of the R2 low-discrepancy sequence (Roberts 2018).
vec2 rayPoint(int i, vec2 shift) {
    return fract(shift + float(i) * vec2(0.7548776662, 0.5698402910));
}

// First surface hit by a straight ray. Cell crossings (Amanatides and Woo 1987) and surfel planes are exact.
// Returns radiance and 1, or 0 on a miss.
vec4 traceStraight(ConeOrigin o, vec3 d, RayUse use) {
    SurfelHit met = traceSurfels(o, d, use.range);
    if (met.emitted > 0.5 && met.distance > use.lamp) met.light = vec4(0.0);
    met.light.rgb *= shareOfRay(use, met.light.rgb, met.emitted, met.distance);
    CONE_SAMPLED(0, met.distance,
        ConeSample(o.surface + met.distance * d, 0.0, 0.0, 2.0 * o.reach, 2.0 * o.reach, 0.0, met.light,
            false, true),
        met.light.a, 1.0 - met.light.a);
    return met.light;
}

// Radiance and opacity of a cell along d (unit length, in cells), per cell length travelled.
vec4 texelAlong(ivec3 cell, vec3 d) {
    if (params.radiance_faces == 1) return texelFetch(voxelRadiance, cell, 0);
    vec4 sum = vec4(0.0);
    for (int axis = 0; axis < 3; axis++)
        sum += abs(d[axis]) * texelFetch(voxelRadiance,
            ivec3(cell.x + (2 * axis + (d[axis] < 0.0 ? 1 : 0)) * params.voxel_dim, cell.yz), 0);
    return sum;
}

// Marches a ray that bends in warped or curved cells, in steps of a quarter cell. Each step subtracts the
// voxel's opacity times the step length from the transmittance. Returns radiance premultiplied by opacity,
// and opacity.
vec4 traceBent(ConeOrigin o, vec3 d, RayUse use) {
    vec3 origin = o.position;
    vec3 color = vec3(0.0);
    float through = 1.0, s = 0.0;
    int dim = params.voxel_dim;
    for (int i = 0; i < 16 * dim && s < use.range; i++) {
        vec3 p = origin + s * d;
        int cascade = cascadeAt(p);
        vec3 u = worldToVolume(volume.maps[cascade], p);
        if (!inVolume(u)) break;
        float cell;
        vec3 direction;
        cellAlong(volume.maps[cascade], p, d, cell, direction);
        vec4 texel = texelAlong(storedCell(min(ivec3(u * float(dim)), ivec3(dim - 1)), cascade), direction);
        if (texel.a > 1e-5) {
            float a = min(0.25 * texel.a, through);
            color += texel.rgb * (a / texel.a);
            through -= a;
            if (through < 1e-3) break;
        }
        s += 0.25 * cell;
    }
    return vec4(color, 1.0 - through);
}

vec4 traceVoxels(ConeOrigin o, vec3 d, RayUse use) {
    if (WARPED || CURVED) return traceBent(o, d, use);
    return traceStraight(o, d, use);
}

#endif
