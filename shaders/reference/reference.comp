#version 460
#extension GL_GOOGLE_include_directive : require
// Path tracing (Kajiya 1986), one sample per pixel, with the surfaces, BRDF and lights of the rasterised
// method. Each vertex samples every light (next-event estimation) and takes one emitter sample. Directions
// are sampled from the cosine, from learned light (reference/guide.glsl) and from the visible GGX normals.
// The first vertex traces one ray per lobe, which separates diffuse and specular light. Rays also hit
// emitters and the sky. Multiple importance sampling combines both estimates of emission
// (reference/emitters.glsl) and of a sky image (reference/sky.glsl).
#include "params.glsl"
#include "reference/incoming.glsl"
#include "reference/camera.glsl"
#include "modules/pixel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// Sums of even samples in layer 0, of odd ones in layer 1; alpha counts them.
layout(rgba32f) uniform image2DArray totalSum;
layout(rgba32f) uniform image2DArray directSum;
layout(rgba32f) uniform image2DArray diffuseSum;
layout(rgba32f) uniform image2DArray specularSum;
layout(rgba32f) uniform image2DArray occlusionSum;
layout(std430) buffer ReferenceErrors { uint not_finite; } referenceErrors;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    uint sample_index = uint(params.first_sample) + pass.index;
    Sequence random = sequenceOf(pixel, sample_index, 0u);
    vec4 u = next4(random);
    vec2 at = vec2(pixel) + (PIXEL_IS_BOX ? u.xy : vec2(0.5));
    // Rays over the pixel's area average its texels themselves; a single ray through its centre needs a
    // filtered lookup.
    Footprint f = PIXEL_IS_BOX
        ? NO_FOOTPRINT
        : Footprint(camera.position, cameraRay(at + vec2(1, 0)).direction,
            cameraRay(at + vec2(0, 1)).direction);
    Ray ray = cameraRay(at);
    Hit hit = traceRay(ray, f, false);

    vec3 total = skyBehind(ray.direction), direct = vec3(0.0), diffuse = vec3(0.0), specular = vec3(0.0);
    float open = 1.0;
    if (hit.triangle != NO_HIT) {
        SurfaceHit h = surfaceOf(hit, ray, f);
        vec3 p = offsetPoint(h.position, h.face);
        direct = directLight(h, random);
        vec4 v = next4(random);
        uint guide = guideOf(h.position, h.face);
        float density;
        LobeSample one = diffuseDirection(guide, h, v.xy, density),
            two = specularSample(h.surface, h.face, h.view, v.zw);
        // Separate random numbers: a path does not depend on the length of the other one.
        Sequence other = sequenceOf(pixel, sample_index, 1u);
        // A path costs the same whatever it carries, so of a weak specular lobe not every sample has one.
        float chance = clamp(4.0 * specularShare(h), 0.25, 1.0);
        SkyLight sky = NO_SKY_LIGHT;
        if (skyHasPicture()) {
            Sequence third = sequenceOf(pixel, sample_index, 2u);
            sky = skyLight(h, guide, vec2(1.0, chance), false, next4(third));
        }
        LobeLight from_emitters = emitterLight(h, guide, vec2(1.0, chance), random);
        bool escaped = false, unused;
        vec3 sun = vec3(0.0);
        // Tests the face and not the weight: black surfaces also have openness.
        if (dot(one.direction, h.face) > 0.0) {
            if (one.weight == vec3(0.0)) escaped = !blocked(Ray(p, one.direction, 1e30));
            else diffuse = one.weight
                * incoming(p, one.direction, density, random, escaped, sun);
            direct += one.weight * sun;
        }
        // Half of the guided directions are of the cosine, in every block of samples that is a power of two.
        float counts = isGuided() ? (isByCosine(v.x) ? 2.0 : 0.0) : 1.0;
        open = escaped ? counts : 0.0;
        if (two.weight != vec3(0.0) && next4(other).x < chance) {
            density = chance * specularDensity(h.surface, h.view, two.direction);
            specular = two.weight / chance * incoming(p, two.direction, density, other, unused, sun);
            direct += two.weight / chance * sun;
        }
        diffuse += sky.diffuse + from_emitters.diffuse;
        specular += sky.specular + from_emitters.specular;
        direct += sky.direct;
        total = h.emission + direct + diffuse + specular;
    }
    if (any(isnan(total)) || any(isinf(total))) {
        atomicAdd(referenceErrors.not_finite, 1u);
        return;
    }
    ivec3 texel = ivec3(pixel, int(sample_index & 1u));
    imageStore(totalSum, texel, imageLoad(totalSum, texel) + vec4(total, 1.0));
    imageStore(directSum, texel, imageLoad(directSum, texel) + vec4(direct, 1.0));
    imageStore(diffuseSum, texel, imageLoad(diffuseSum, texel) + vec4(diffuse, 1.0));
    imageStore(specularSum, texel, imageLoad(specularSum, texel) + vec4(specular, 1.0));
    imageStore(occlusionSum, texel, imageLoad(occlusionSum, texel) + vec4(vec3(open), 1.0));
}
