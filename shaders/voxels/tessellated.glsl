// Number of cascades that the tessellator voxelizes. Next to the rasteriser, only the curved one.
int tessellatedCascades() {
    return CURVED && params.voxelizer != VOXELIZER_TESSELLATED ? 1 : CASCADE_COUNT;
}
