// Light of methods whose pixels gather in different directions: filtered over 8x8 pixels.
uniform sampler2D gatheredDiffuse;
uniform sampler2D gatheredSpecular;
uniform sampler2D smoothedDiffuse;
uniform sampler2D smoothedSpecular; // a: weight of the pixel, less if its light is older than a change

Filtered unfiltered(ivec2 pixel) {
    return Filtered(texelFetch(gatheredDiffuse, pixel, 0), texelFetch(gatheredSpecular, pixel, 0).rgb);
}

// Mean of 2x2 smoothed pixels: with smooth.comp, of 8x8 pixels that see the same surface.
Filtered filtered(ivec2 pixel, GBufferSurface seen) {
    vec4 diffuse = vec4(0.0);
    vec3 specular = vec3(0.0);
    float diffuse_weights = 0.0, specular_weights = 0.0;
    EdgeStop stop = edgeStopOf(pixel, seen);
    for (int i = 0; i < 4; i++) {
        ivec2 at = pixel + ivec2(i & 1, i >> 1);
        FilterWeights weights = filterWeights(at, stop);
        vec4 reflected = texelFetch(smoothedSpecular, at, 0);
        weights.diffuse *= reflected.a;
        weights.specular *= reflected.a;
        diffuse += weights.diffuse * texelFetch(smoothedDiffuse, at, 0);
        specular += weights.specular * reflected.rgb;
        diffuse_weights += weights.diffuse;
        specular_weights += weights.specular;
    }
    vec3 reflectance = max(lobeReflectance(seen.surface, seen.to_viewer), MIN_REFLECTANCE);
    specular *= reflectance / max(specular_weights, 1e-6);
    return Filtered(diffuse / max(diffuse_weights, 1e-6), specular);
}

Filtered gatheredLight(ivec2 pixel, GBufferSurface seen) {
    return params.pattern == 1 ? unfiltered(pixel) : filtered(pixel, seen);
}
