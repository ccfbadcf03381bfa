// Directions that meet nothing in the picture go on as rays through the voxels' surfels.
#include "surfels/ray_origin.glsl"
#include "surfels/trace.glsl"
#include "lights/sky.glsl"

vec3 missedLight(GBufferSurface seen, vec3 d, float spread, inout float open) {
    ConeOrigin o = coneOrigin(seen.position, seen.face, seen.surface.normal);
    SurfelHit met = traceSurfels(o, d, 1e30);
    if (met.light.a > 0.0) open = 0.0;
    return met.light.a > 0.0 ? met.light.rgb : skyRadiance(d, spread);
}
