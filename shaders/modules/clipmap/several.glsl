// A volume of several cascades, some of whose cells may be kept from frame to frame.
// warps.ron says the same in `cascade_count`; here it is a constant that the compiler unrolls by.
#define CASCADE_COUNT (!CURVED ? CASCADES : FALLBACK ? 1 + CASCADES : 1)

#define SCROLLS VOLUME_SCROLL

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

// Whether a place in cells is one whose content stays as it was.
bool isKept(VolumeMap map, vec3 at) {
    return SCROLLS && all(greaterThan(at, vec3(map.kept_from))) && all(lessThan(at, vec3(map.kept_to)));
}
