// Several cascades, stored one behind the other along z in textures.

// The finest cascade that contains p, or else the coarsest.
int cascadeAt(vec3 p) {
    int k = 0;
    while (k < CASCADE_COUNT - 1 && !holds(volume.maps[k], p)) k++;
    return k;
}

// Converts a cascade's cell to texture coordinates.
ivec3 storedCell(ivec3 cell, int cascade) {
    return ivec3(cell.xy, cell.z + cascade * params.voxel_dim);
}

// Cascade of a cell in texture coordinates.
int cascadeOf(ivec3 stored) {
    return CASCADE_COUNT > 1 ? stored.z / params.voxel_dim : 0;
}
