// A volume of several cascades, rebuilt every frame.
#define CASCADE_COUNT params.cascade_count
const bool SCROLLS = false;

#include "volume/cascades.glsl"

bool isReprojected(VolumeMap map, vec3 at) {
    return false;
}
