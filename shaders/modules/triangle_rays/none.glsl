// All rays hit voxels.
vec4 traceSurfaces(ConeOrigin o, vec3 d, float tan_lobe, RayUse use) {
    return traceVoxels(o, d, use);
}
