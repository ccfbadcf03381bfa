// cone_count cones, fitted for the lobe that lod_offset -2 leaves of the aperture, about 11 degrees to each side.
ConeSet diffuseConeSet() {
    return makeConeSet(params.cone_count, 0.33, 59.0);
}
