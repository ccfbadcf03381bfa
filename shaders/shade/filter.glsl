// The mean of what the pixels around have gathered, of those that see the same surface.
#ifndef SHADE_FILTER_GLSL
#define SHADE_FILTER_GLSL

struct Filtered {
    vec4 hemisphere; // rgb: mean radiance over the hemisphere, cosine-weighted; a: how open it is
    vec3 specular; // radiance towards the viewer
};

// How much of another pixel's light a surface takes: 1 where both see one surface.
float likeness(ivec2 at, GBufferSurface seen) {
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(camera.size)))) return 0.0;
    float other = texelFetch(gbufferDistance, at, 0).r;
    if (other <= 0.0) return 0.0;
    vec3 normal = unpackNormal(texelFetch(gbufferNormals, at, 0).xy);
    float off = abs(dot(camera.position + other * viewRay(vec2(at) + 0.5) - seen.position, seen.face));
    return clamp(5.0 * abs(dot(normal, seen.surface.normal)) - 3.8, 0.0, 1.0) * clamp(2.0 - 200.0 * off / distance(seen.position, camera.position), 0.0, 1.0);
}

// How far a surface's reflection may blur: a mirror's picture must not.
float blurs(GBufferSurface seen) {
    return smoothstep(0.05, 0.25, seen.surface.roughness);
}

// The nearest pixels of the lattice are this one, and those one step to the right, one down, and both.
ivec2 latticeBefore(ivec2 pixel) {
    return pixel & -params.ray_step;
}

// Whether they say nothing of the surface that a pixel sees.
bool isAlone(ivec2 pixel, GBufferSurface seen) {
    float weights = 0.0;
    for (int i = 0; i < 4; i++) weights += likeness(latticeBefore(pixel) + params.ray_step * ivec2(i & 1, i >> 1), seen);
    return weights < 0.25;
}

#endif
