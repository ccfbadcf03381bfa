// The mean of what the pixels around have gathered, of those that see the same surface.
#ifndef SHADE_FILTER_GLSL
#define SHADE_FILTER_GLSL

struct Filtered {
    vec4 hemisphere; // rgb: mean radiance over the hemisphere, cosine-weighted; a: how open it is
    vec3 specular; // radiance towards the viewer
};

// What tells whether other pixels see the same surface, worked out once for all of them.
struct Likeness {
    vec2 origin, step; // of the pixels' rays: tangents of their angles
    vec3 plane; // the surface's normal, of rays in view space
    float away; // of the plane from the camera [m]
    float scale; // of how far off the plane a surface may be [1/m]
    vec3 normal;
};

Likeness likenessOf(GBufferSurface seen) {
    vec2 zoom = 1.0 / vec2(camera.projection[0][0], camera.projection[1][1]);
    vec2 step = 2.0 * zoom / vec2(camera.size);
    vec3 off = seen.position - camera.position;
    return Likeness(0.5 * step - zoom, step, mat3(camera.view) * seen.face, dot(off, seen.face), 200.0 / length(off), seen.surface.normal);
}

// What other pixels see: a normal, and how far it is [m]; 0 beyond the picture and where they see the sky.
vec4 seenAt(ivec2 at) {
    if (any(greaterThanEqual(uvec2(at), uvec2(camera.size)))) return vec4(0.0);
    return vec4(unpackNormal(texelFetch(gbufferNormals, at, 0).xy), texelFetch(gbufferDistance, at, 0).r);
}

// How much of another pixel's light a surface takes: 1 where both see one surface.
float likeness(ivec2 at, Likeness like) {
    vec4 other = seenAt(at);
    if (other.w <= 0.0) return 0.0;
    vec2 ray = like.origin + vec2(at) * like.step;
    float off = abs(other.w * inversesqrt(dot(ray, ray) + 1.0) * (dot(ray, like.plane.xy) - like.plane.z) - like.away);
    return clamp(5.0 * abs(dot(other.xyz, like.normal)) - 3.8, 0.0, 1.0) * clamp(2.0 - like.scale * off, 0.0, 1.0);
}

// How far a surface's reflection may blur: a mirror's picture must not.
float blurs(GBufferSurface seen) {
    return smoothstep(0.05, 0.25, seen.surface.roughness);
}

#endif
