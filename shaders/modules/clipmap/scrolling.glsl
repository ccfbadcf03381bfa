// A volume of several cascades. With VOLUME_SCROLL, cells that stay in the volume are reprojected.
#define CASCADE_COUNT params.cascade_count
#define SCROLLS VOLUME_SCROLL

#include "volume/cascades.glsl"

// Whether a position [cells] is inside the range that keeps its history.
bool isReprojected(VolumeMap map, vec3 at) {
    return SCROLLS && all(greaterThan(at, vec3(map.history_from))) && all(lessThan(at, vec3(map.history_to)));
}
