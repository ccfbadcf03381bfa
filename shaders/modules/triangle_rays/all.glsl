// All rays of pixels hit triangles.
#include "surfels/triangles.glsl"

vec4 traceSurfaces(ConeOrigin o, vec3 d, float tan_lobe, RayUse use) {
    return traceTriangles(o, d, use);
}
