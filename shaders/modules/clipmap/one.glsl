// A volume of one cascade, rebuilt every frame.
const int CASCADE_COUNT = 1;
const bool SCROLLS = false;

int cascadeAt(vec3 p) {
    return 0;
}

ivec3 storedCell(ivec3 cell, int cascade) {
    return cell;
}

int cascadeOf(ivec3 stored) {
    return 0;
}

bool isReprojected(VolumeMap map, vec3 at) {
    return false;
}
