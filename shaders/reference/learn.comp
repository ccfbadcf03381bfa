#version 460
#extension GL_GOOGLE_include_directive : require
// Paths that learn where light comes from (reference/guide.glsl). They count in no picture.
#include "params.glsl"
#define LEARNS
#include "reference/incoming.glsl"
#include "reference/camera.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    Sequence random = sequenceOf(pixel, pass.index, 3u);
    Ray ray = cameraRay(vec2(pixel) + next4(random).xy);
    Hit hit = traceRay(ray, NO_FOOTPRINT, false);
    if (hit.triangle == NO_HIT) return;
    SurfaceHit h = surfaceOf(hit, ray, NO_FOOTPRINT);
    vec3 d = frameOf(h.surface.normal) * cosineSample(next4(random).xy);
    if (dot(d, h.face) <= 0.0) return;
    float density = diffuseDensity(h.surface, d);
    GuideVertex first = guideVertex(guideOf(h.position, h.face), h.surface, d, density, vec3(0.0), vec3(1.0));
    bool escaped;
    vec3 sun;
    guideRecord(first, incoming(offsetPoint(h.position, h.face), d, density, random, escaped, sun));
}
