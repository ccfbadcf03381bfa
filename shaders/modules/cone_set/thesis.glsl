// Five cones of 45 degrees, weighted alike (thesis, Section 4.5.2).
ConeSet diffuseConeSet() {
    return makeConeSet(5, 0.2, 45.0);
}
