// A volume of several cascades, some of whose cells may be kept from frame to frame.
#define CASCADE_COUNT params.cascade_count
#define SCROLLS VOLUME_SCROLL

#include "volume/cascades.glsl"

// Whether a place in cells is one whose content stays as it was.
bool isReprojected(VolumeMap map, vec3 at) {
    return SCROLLS && all(greaterThan(at, vec3(map.history_from))) && all(lessThan(at, vec3(map.history_to)));
}
