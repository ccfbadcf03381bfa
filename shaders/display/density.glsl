// Cell density relative to no warp, as hue: red up to 1/2, green 1, blue from 2 (thesis, Figure 5.7). Warp
// functions use one axis. Curved cells and several cascades use the mean edge relative to the coarsest
// cascade.
vec3 densityColor(VolumeMap map, vec3 p) {
    vec3 coarsest = volume.maps[CASCADE_COUNT - 1].cell;
    float density = CURVED || CASCADE_COUNT > 1
        ? pow(coarsest.x * coarsest.y * coarsest.z / max(abs(determinant(cellAxes(map, p))), 1e-20),
            1.0 / 3.0)
        : warpSlope(clamp((p - map.minimum) / map.size, 0.0, 1.0))[clamp(params.density_axis, 0, 2)];
    float t = clamp(log2(max(density, 1e-6)), -1.0, 1.0);
    return t < 0.0 ? mix(vec3(0, 1, 0), vec3(1, 0, 0), -t) : mix(vec3(0, 1, 0), vec3(0, 0, 1), t);
}
