// cone_count wide cones with fitted weights.
ConeSet diffuseConeSet() {
    return makeConeSet(params.cone_count, 0.15, 45.0);
}
