// Cascades that the tessellator fills: beside the rasteriser, the curved one.
int tessellatedCascades() {
    return CURVED && params.voxelizer == VOXELIZER_RASTER ? 1 : CASCADE_COUNT;
}
