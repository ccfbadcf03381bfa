// Six cones of 60 degrees (Crassin et al. 2011).
ConeSet diffuseConeSet() {
    return makeConeSet(6, 0.25, 60.0);
}
