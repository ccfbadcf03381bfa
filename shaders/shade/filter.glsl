// Edge-stopping weights of the filter over gathered light.
#ifndef SHADE_FILTER_GLSL
#define SHADE_FILTER_GLSL

struct Filtered {
    vec4 hemisphere; // rgb: mean radiance over the hemisphere, cosine-weighted; a: openness
    vec3 specular; // radiance towards the viewer
};

// Surface of the filtered pixel, prepared for comparison with other pixels.
struct EdgeStop {
    vec2 origin, step; // map pixels to rays: tangents of their angles
    vec3 plane; // the surface's normal in view space
    float away; // signed distance of the plane from the camera [m]
    float scale; // of the distance between a surface and the plane [1/m]
    vec3 normal;
};

EdgeStop edgeStopOf(GBufferSurface seen) {
    vec2 zoom = 1.0 / vec2(camera.projection[0][0], camera.projection[1][1]);
    vec2 step = 2.0 * zoom / vec2(camera.size);
    vec3 off = seen.position - camera.position;
    vec3 plane = mat3(camera.view) * seen.face;
    float away = dot(off, seen.face), scale = 200.0 / length(off);
    return EdgeStop(0.5 * step - zoom, step, plane, away, scale, seen.surface.normal);
}

// Normal and distance [m] of the surface at a pixel. The distance is 0 outside the image and for the sky.
vec4 seenAt(ivec2 at) {
    if (any(greaterThanEqual(uvec2(at), uvec2(camera.size)))) return vec4(0.0);
    return vec4(unpackNormal(texelFetch(gbufferNormals, at, 0).xy), texelFetch(gbufferDistance, at, 0).r);
}

// Weight of another pixel's light: 1 if both pixels see one surface.
float edgeStoppingWeight(ivec2 at, EdgeStop stop) {
    vec4 other = seenAt(at);
    if (other.w <= 0.0) return 0.0;
    vec2 ray = stop.origin + vec2(at) * stop.step;
    float away = other.w * inversesqrt(dot(ray, ray) + 1.0) * (dot(ray, stop.plane.xy) - stop.plane.z);
    float off = abs(away - stop.away), cosine = abs(dot(other.xyz, stop.normal));
    return clamp(5.0 * cosine - 3.8, 0.0, 1.0) * clamp(2.0 - stop.scale * off, 0.0, 1.0);
}

// Weight of other pixels' reflections: 0 for mirrors, which must stay sharp.
float reflectionBlur(GBufferSurface seen) {
    return smoothstep(0.05, 0.25, seen.surface.roughness);
}

#endif
