// Where voxels lie now, where `volume` says where they lay last frame.
layout(std430) readonly buffer Placed {
    VolumeMap maps[MAX_CASCADES];
    uint signature;
} placed;
