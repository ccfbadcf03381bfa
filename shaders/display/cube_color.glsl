// Colour of the voxel view's cubes.
uniform sampler3D shown; // the shown level of voxelAttribute

vec3 cellColor(ivec3 cell, vec3 center, int face) {
    vec4 radiance = shownTexel(cell, face);
    if (params.voxel_view == VOXEL_VIEW_RADIANCE) return radiance.rgb / max(radiance.a, 1e-4);
    if (params.voxel_view == VOXEL_VIEW_ALPHA) return vec3(radiance.a);
    vec4 mean = texelFetch(shown, ivec3(cell.xy, cell.z + shownCascade() * shownCells()), 0);
    if (params.voxel_view == VOXEL_VIEW_COLOR) return mean.rgb / max(mean.a, 1e-4);
    return (dot(mean.rgb, mean.rgb) > 1e-12 ? normalize(mean.rgb) : vec3(0.0)) * 0.5 + 0.5;
}
