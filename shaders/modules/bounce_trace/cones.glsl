// Voxels gather with narrow cones.
#include "modules/cone.glsl"

vec4 traceBounce(ConeOrigin o, vec3 d) {
    return traceCone(o, d, tan(radians(0.5 * params.bounce_aperture)), params.diffuse_steps);
}
