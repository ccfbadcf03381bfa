// The current volume, in passes where `volume` is last frame's.
layout(std430) readonly buffer Placed {
    VolumeMap maps[MAX_CASCADES];
    uint signature;
} placed;
