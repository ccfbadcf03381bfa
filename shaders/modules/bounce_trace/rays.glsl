// Voxels gather with rays that meet others' surfaces.
#include "modules/lookup.glsl"
#include "cones/rays.glsl"

vec4 traceBounce(ConeOrigin o, vec3 d) {
    return traceVoxels(o, d);
}
