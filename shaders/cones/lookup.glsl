// Cone lookups in a volume of several cascades: a sample reads the finest cascade that contains it, and
// blends into the next one near the border.
#include "cones/cascade_lookup.glsl"
#include "modules/opacity.glsl"
#include "cones/level.glsl"
#include "cones/sample.glsl"

// Cones that differ between neighbouring pixels round to whole levels, which halves the texture reads, and
// cross empty space in double steps. Both errors are below the noise between them. Equal cones would band.
#ifndef INTERLEAVED_CONES
#define INTERLEAVED_CONES false
#endif

// State of a cone.
struct Cone {
    ConeOrigin origin;
    vec3 direction;
    float tan_half; // of half the aperture
    float rise; // above the surface per metre
    int cascade; // of the last sample
    float voxel; // length of its level-0 cell along the cone [m]
    vec3 dir; // direction in its cells, unit length
    bool empty; // the last texel was transparent
};

Cone coneFrom(ConeOrigin o, vec3 d, float tan_half, out float first_cell) {
    Cone cone = Cone(o, d, tan_half, max(dot(d, o.normal), 0.0), o.cascade, 0.0, vec3(0.0), false);
    cellAlong(volume.maps[o.cascade], o.position, d, cone.voxel, cone.dir);
    first_cell = cone.voxel;
    if (CASCADE_COUNT > 1 && o.weight < 1.0)
        first_cell = mix(cellLength(volume.maps[o.cascade + 1], o.position, d), cone.voxel, o.weight);
    return cone;
}

// Cones with an aperture above 12 degrees (this is the tangent of its half) avoid coarse levels with cells
// that contain the surface that they leave: an open plane would shadow itself. Narrow cones stay clear of it
// anyway.
const float CLEARED = 0.105;

// The coarsest level with a lookup, 1.5 cells to each side, that fits between p and the surface. height: of p
// above the surface's plane [m].
float clearLevel(Cone cone, int cascade, vec3 p, float height) {
    float reach = max(cellReach(volume.maps[cascade], p, cone.origin.normal), cone.origin.reach);
    return floor(log2(max(height / (3.0 * reach), 1.0)) + 1e-3);
}

float levelAt(Cone cone, int cascade, vec3 p, float voxel, float radius, float height) {
    float level = coneLevel(voxel, radius);
    if (cone.tan_half > CLEARED) level = min(level, clearLevel(cone, cascade, p, height));
    return clamp(INTERLEAVED_CONES ? round(level) : level, 0.0, volume.maps[cascade].last);
}

// Blends a sample with the next cascade. weight: of the current one.
void blendNext(Cone cone, inout ConeSample x, float height, float weight) {
    int next = cone.cascade + 1;
    vec3 u = worldToVolume(volume.maps[next], x.position), dir;
    if (!inVolume(u)) return;
    float voxel;
    cellAlong(volume.maps[next], x.position, cone.direction, voxel, dir);
    float level = levelAt(cone, next, x.position, voxel, x.radius, height);
    vec4 found = sampleMap(u, next, dir, level);
    found *= opacityScale(found.a, x.voxel, x.cell, voxel, voxel * exp2(level));
    x.texel = mix(found, x.texel, weight);
}

// Whether the cells two levels coarser are empty. Then the footprint of the next sample is empty too.
bool isEmptyAround(vec3 u, Cone cone, float level) {
    float wide = level + 2.0;
    if (wide > volume.maps[cone.cascade].last) return false;
    return (CASCADE_COUNT == 1 || cascadeWeight(u, wide) == 1.0)
        && sampleMap(u, cone.cascade, cone.dir, wide).a == 0.0;
}

ConeSample coneSample(inout Cone cone, int number, float along) {
    ConeSample x;
    x.position = cone.origin.position + along * cone.direction;
    x.radius = along * cone.tan_half;
    int before = cone.cascade;
    if (CASCADE_COUNT > 1) cone.cascade = cascadeAt(x.position);
    int k = cone.cascade;
    vec3 u = worldToVolume(volume.maps[k], x.position);
    // Beyond the border of boxes, the clamped lookup repeats the border cells once. A coarse cell that holds
    // the outermost wall reaches up to the border, and stopping short of it would leak light.
    x.last = !inVolume(u);
    x.outside = x.last && (number == 0 || k != before || CURVED && volume.maps[k].curved != 0);
    if (x.outside) return x;
    if (WARPED || CASCADE_COUNT > 1)
        cellAlong(volume.maps[k], x.position, cone.direction, cone.voxel, cone.dir);
    x.voxel = cone.voxel;
    float height = cone.origin.height + along * cone.rise;
    x.level = levelAt(cone, k, x.position, x.voxel, x.radius, height);
    x.cell = x.voxel * exp2(x.level);
    x.advance = max(params.step_factor * x.cell, 0.05 * x.voxel);
    if (INTERLEAVED_CONES && cone.empty && isEmptyAround(u, cone, x.level)) {
        x.texel = vec4(0.0);
        x.advance *= 2.0;
        return x;
    }
    x.texel = sampleMap(u, k, cone.dir, x.level);
    cone.empty = x.texel.a == 0.0;
    if (CASCADE_COUNT > 1 && k < CASCADE_COUNT - 1) {
        float weight = cascadeWeight(u, x.level);
        if (weight < 1.0) blendNext(cone, x, height, weight);
    }
    return x;
}
