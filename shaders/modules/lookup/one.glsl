// Lookups of cones in a volume of one cascade with cells of one size.
#include "cones/origin.glsl"
#include "modules/opacity.glsl"
#include "modules/mips.glsl"

// A cone on its way.
struct Cone {
    VolumeMap map; // loaded once, before the march
    ConeOrigin origin;
    vec3 direction;
    float tan_half; // of half the aperture
    float rise; // above the surface for each metre
    float cell; // length of a level-0 cell along the cone [m]
    vec3 dir; // direction in cells, unit length
};

#include "cones/sample.glsl"
#include "cones/clearance.glsl"

// Starts outside the voxels of the cone's own surface: `bias` cell extents off it.
ConeOrigin coneOrigin(vec3 p, vec3 geometric, vec3 shading) {
    float reach = cellReach(volume.maps[0], p, geometric);
    float height = 2.0 * params.bias * reach;
    return ConeOrigin(p + height * geometric, geometric, height, reach, 0, 1.0);
}

Cone coneFrom(ConeOrigin o, vec3 d, float tan_half, out float first_cell) {
    Cone cone = Cone(volume.maps[0], o, d, tan_half, max(dot(d, o.normal), 0.0), 0.0, vec3(0.0));
    cellAlong(cone.map, o.position, d, cone.cell, cone.dir);
    first_cell = cone.cell;
    return cone;
}

ConeSample coneSample(inout Cone cone, int number, float along) {
    ConeSample x;
    x.position = cone.origin.position + along * cone.direction;
    x.radius = along * cone.tan_half;
    vec3 u = worldToVolume(cone.map, x.position);
    // Past the border the clamped lookup gives the border cells once more: a coarse cell that holds the outermost wall
    // reaches to the border, and stopping short of it would let light out.
    x.last = !inVolume(u);
    x.outside = x.last && number == 0;
    if (x.outside) return x;
    float height = cone.origin.height + along * cone.rise;
    x.level = clearLevel(coneLevel(cone.cell, x.radius), height, cone.origin.reach, cone.map.last);
    x.voxel = cone.cell;
    x.cell = cone.cell * exp2(x.level);
    x.advance = max(params.step_factor * x.cell, 0.05 * x.voxel);
    x.texel = sampleLevel(u, cone.dir, x.level);
    return x;
}
