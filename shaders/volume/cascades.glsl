// Several cascades, one behind the other along z in textures.

// The finest cascade that holds p; else the coarsest.
int cascadeAt(vec3 p) {
    int k = 0;
    while (k < CASCADE_COUNT - 1 && !holds(volume.maps[k], p)) k++;
    return k;
}

// Where textures keep a cascade's cell, and back.
ivec3 storedCell(ivec3 cell, int cascade) {
    return ivec3(cell.xy, cell.z + cascade * params.voxel_dim);
}

int cascadeOf(ivec3 stored) {
    return CASCADE_COUNT > 1 ? stored.z / params.voxel_dim : 0;
}
