// Rays into narrow lobes hit triangles; others hit voxels.
#include "surfels/triangles.glsl"

// Widest lobe whose rays hit triangles, as the tangent of a ray's share: just above a roughness of 0.3.
const float WIDEST_MIRROR = 0.025;

// tan_lobe is 0 for rays that do not reflect.
vec4 traceSurfaces(ConeOrigin o, vec3 d, float tan_lobe, RayUse use) {
    if (tan_lobe > 0.0 && tan_lobe <= WIDEST_MIRROR) return traceTriangles(o, d, use);
    return traceVoxels(o, d, use);
}
