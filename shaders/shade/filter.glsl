// Weights of the filter over gathered light. Reflections are averaged over pixels whose lobes point the same
// way: over the whole block on rough surfaces, over no other pixel on mirrors.
#ifndef SHADE_FILTER_GLSL
#define SHADE_FILTER_GLSL
#include "shade/lobe_filter.glsl"

struct Filtered {
    vec4 hemisphere; // rgb: mean radiance over the hemisphere, cosine-weighted; a: openness
    vec3 specular; // radiance towards the viewer
};

// Weights of another pixel's light: 1 if both pixels see one surface.
struct FilterWeights {
    float diffuse;
    float specular;
};

// Surface of the filtered pixel, prepared for comparison with other pixels.
struct EdgeStop {
    ivec2 pixel;
    vec2 origin, step; // map pixels to rays: tangents of their angles
    vec3 plane; // the surface's normal in view space
    float away; // signed distance of the plane from the camera [m]
    float scale; // of the distance between a surface and the plane [1/m]
    vec3 normal;
    float narrow; // of the squared angle between reflected directions, relative to the lobe [1/rad^2]
    float turn; // squared angle between the rays of neighbouring pixels, times narrow
};

EdgeStop edgeStopOf(ivec2 pixel, GBufferSurface seen) {
    vec2 zoom = 1.0 / vec2(camera.projection[0][0], camera.projection[1][1]);
    vec2 step = 2.0 * zoom / vec2(camera.size);
    vec3 off = seen.position - camera.position;
    vec3 plane = mat3(camera.view) * seen.face;
    float away = dot(off, seen.face), scale = 200.0 / length(off);
    float narrow = 1.0 / reflectionWidth2(seen.surface);
    return EdgeStop(pixel, (0.5 + pixelOffset()) * step - zoom, step, plane, away, scale,
        seen.surface.normal, narrow, narrow * pixelAngle2());
}

// Normal and distance [m] of the surface at a pixel. The distance is 0 outside the image and for the sky.
vec4 seenAt(ivec2 at) {
    if (any(greaterThanEqual(uvec2(at), uvec2(camera.size)))) return vec4(0.0);
    return vec4(unpackNormal(texelFetch(gbufferNormals, at, 0).xy), texelFetch(gbufferDistance, at, 0).r);
}

FilterWeights filterWeights(ivec2 at, EdgeStop stop) {
    if (at == stop.pixel) return FilterWeights(1.0, 1.0);
    vec4 other = seenAt(at);
    if (other.w <= 0.0) return FilterWeights(0.0, 0.0);
    vec2 ray = stop.origin + vec2(at) * stop.step, apart = vec2(at - stop.pixel);
    float away = other.w * inversesqrt(dot(ray, ray) + 1.0) * (dot(ray, stop.plane.xy) - stop.plane.z);
    float off = abs(away - stop.away), cosine = abs(dot(other.xyz, stop.normal));
    float same = clamp(5.0 * cosine - 3.8, 0.0, 1.0) * clamp(2.0 - stop.scale * off, 0.0, 1.0);
    // A normal that turns by an angle turns its reflection by twice as much; 2 - 2 cos is the angle's square.
    float turned = stop.turn * dot(apart, apart) + stop.narrow * 8.0 * max(1.0 - cosine, 0.0);
    return FilterWeights(same, same * exp2(-turned));
}

#endif
