// Five equally weighted cones, tilted by 45 degrees (thesis, Section 4.5.2).
ConeSet diffuseConeSet() {
    return makeConeSet(5, 0.2, 45.0);
}
