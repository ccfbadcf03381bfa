// Rays that hit the scene's triangles instead of the voxels: exact where they hit, and as dear as the
// hierarchy is deep. Light at the hit: emission, direct light by the shadow map, and the light that the
// surfel there has gathered.
#ifndef TRIANGLE_RAYS_GLSL
#define TRIANGLE_RAYS_GLSL
#include "reference/hit.glsl"
#include "shadow/visibility.glsl"
#include "lights/direct.glsl"

// Light gathered by the surfel at or next to p that faces the same way; 0 if there is none.
vec3 gatheredAt(vec3 p, vec3 face) {
    int cascade = cascadeAt(p);
    vec3 at = worldToVolume(volume.maps[cascade], p) * float(params.voxel_dim);
    uint axis = axisOf(face), side = sideOf(face, axis);
    for (int i = 0; i < 3; i++) { // this cell, the one behind the surface, the one in front
        vec3 moved = at;
        moved[axis] += (i == 0 ? 0.0 : i == 1 ? -0.5 : 0.5) * sign(face[axis]);
        ivec3 cell = ivec3(floor(moved));
        if (!inGrid(cell)) continue;
        uint found = foundAt(cell, cascade);
        if ((found >> axis & 1u) != 0)
            return lightOf(sideGathered.list[sideIndex(surfelOf(found, axis), side)]);
    }
    return vec3(0.0);
}

// Start of rays above their surface, as a share of the height that keeps them off its voxels.
const float TRIANGLE_BIAS = 0.3;

// First triangle hit by a straight ray. Returns radiance and 1, or 0 on a miss.
vec4 traceTriangles(ConeOrigin o, vec3 d, RayUse use) {
    float lower = (1.0 - TRIANGLE_BIAS) * 2.0 * params.ray_bias * o.reach;
    Ray ray = Ray(o.surface - lower * o.normal, d, use.range);
    Hit hit = traceRay(ray, NO_FOOTPRINT, false);
    if (hit.triangle == NO_HIT) return vec4(0.0);
    SurfaceHit h = surfaceOf(hit, ray, NO_FOOTPRINT);
    Surface s = h.surface;
    vec3 emitted = hit.t > use.lamp ? vec3(0.0) : h.emission;
    vec3 light = emitted + directLight(s, h.position, h.face, h.view)
        + min(s.albedo + lobeReflectance(s, h.view), 1.0) * gatheredAt(h.position, h.face);
    light *= shareOfRay(use, light, luminance(emitted) / max(luminance(light), 1e-20), hit.t);
    return vec4(light, 1.0);
}

#endif
