// Cascades that the tessellator fills: beside the rasteriser, the curved one.
int tessellatedCascades() {
    return CURVED && params.voxelizer != VOXELIZER_TESSELLATED ? 1 : CASCADE_COUNT;
}
