// A ray through cells of one size: crossings are exact (Amanatides and Woo 1987), and in each cell the ray meets its surfaces'
// planes. Returns radiance and 1, or 0 where it meets none.
#include "cones/near.glsl"
#include "cones/sample.glsl"
#include "cones/emitters.glsl"

vec4 traceVoxels(ConeOrigin o, vec3 d, RayUse use) {
    Met met = meetSurface(o, d, use.range);
    if (met.emitted > 0.5 && met.distance > use.lamp) met.light = vec4(0.0);
    met.light.rgb *= shareOfRay(use, met.light.rgb, met.emitted, met.distance);
    CONE_SAMPLED(0, met.distance, ConeSample(o.surface + met.distance * d, 0.0, 0.0, 2.0 * o.reach, 2.0 * o.reach, 0.0, met.light, false, true), met.light.a, 1.0 - met.light.a);
    return met.light;
}
