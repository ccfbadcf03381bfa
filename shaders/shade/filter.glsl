// The mean of what the pixels around have gathered, of those that see the same surface.
#ifndef SHADE_FILTER_GLSL
#define SHADE_FILTER_GLSL

uniform sampler2D gatheredDiffuse;
uniform sampler2D gatheredSpecular;

struct Filtered {
    vec4 hemisphere; // rgb: mean radiance over the hemisphere, cosine-weighted; a: how open it is
    vec3 specular; // radiance towards the viewer
};

Filtered unfiltered(ivec2 pixel) {
    return Filtered(texelFetch(gatheredDiffuse, pixel, 0), texelFetch(gatheredSpecular, pixel, 0).rgb);
}

// Over `across` x `across` pixels, `stride` apart, the first at `first` from the pixel.
Filtered filterGathered(ivec2 pixel, GBufferSurface seen, int first, int stride, int across) {
    // A mirror's picture must not blur.
    float lobe = smoothstep(0.05, 0.25, seen.surface.roughness), range = distance(seen.position, camera.position);
    vec4 diffuse = vec4(0.0);
    vec3 specular = vec3(0.0);
    float weights = 0.0, specular_weights = 0.0;
    for (int i = 0; i < across * across; i++) {
        ivec2 at = pixel + first + stride * ivec2(i % across, i / across);
        if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(camera.size)))) continue;
        float other = texelFetch(gbufferDistance, at, 0).r;
        if (other <= 0.0) continue;
        vec3 normal = unpackNormal(texelFetch(gbufferNormals, at, 0).xy);
        float off = abs(dot(camera.position + other * viewRay(vec2(at) + 0.5) - seen.position, seen.face));
        float weight = clamp(5.0 * abs(dot(normal, seen.surface.normal)) - 3.8, 0.0, 1.0) * clamp(2.0 - 200.0 * off / range, 0.0, 1.0);
        if (at == pixel) weight = 1.0;
        Filtered there = unfiltered(at);
        diffuse += weight * there.hemisphere;
        weights += weight;
        weight *= at == pixel ? 1.0 : lobe;
        specular += weight * there.specular;
        specular_weights += weight;
    }
    return Filtered(diffuse / weights, specular / specular_weights);
}

#endif
