// Light of methods that gather over the hemisphere only. The specular lobe reflects the hemisphere's mean.
uniform sampler2D gatheredDiffuse;

Filtered gatheredLight(ivec2 pixel, GBufferSurface seen) {
    vec4 hemisphere = texelFetch(gatheredDiffuse, pixel, 0);
    if (REFLECTIONS == REFLECTIONS_NONE) return Filtered(hemisphere, vec3(0.0));
    return Filtered(hemisphere, lobeReflectance(seen.surface, seen.to_viewer) * hemisphere.rgb);
}
