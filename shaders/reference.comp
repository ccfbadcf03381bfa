#version 460
#extension GL_GOOGLE_include_directive : require
// One sample of every pixel by path tracing (Kajiya 1986), with the surfaces, the BRDF and the lights of the
// rasterised method. Every light is asked at every vertex (next-event estimation); directions are drawn from the
// cosine and from the visible GGX normals. The first vertex sends out two rays, one for each lobe, so that
// diffuse and specular light are known apart. Emission and the sky are met by the rays.
#include "params.glsl"
#include "direct.glsl"
#include "hit.glsl"
#include "frame.glsl"
#include "random.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// Sums over the even samples in layer 0, over the odd ones in layer 1; alpha counts them.
layout(rgba32f) uniform image2DArray totalSum;
layout(rgba32f) uniform image2DArray directSum;
layout(rgba32f) uniform image2DArray diffuseSum;
layout(rgba32f) uniform image2DArray specularSum;
layout(rgba32f) uniform image2DArray occlusionSum;
layout(std430) buffer ReferenceErrors { uint not_finite; } referenceErrors;

float lightVisibility(Light light, vec3 p, vec3 face, vec3 to_light) {
    if (light.shadow_view < 0) return 1.0; // casts no shadows
    vec3 from = offsetPoint(p, face);
    float end = light.kind == LIGHT_DIRECTIONAL ? 1e30 : distance(light.position, from) * 0.9999;
    return blocked(Ray(from, to_light, end)) ? 0.0 : 1.0;
}

// A direction, and BRDF * cosine / density; the direction is of no use where that is 0.
struct Bounce {
    vec3 direction;
    vec3 weight;
};

Bounce diffuseBounce(SurfaceHit h, vec2 u) {
    float r = sqrt(u.x), angle = 2.0 * PI * u.y;
    vec3 l = frameOf(h.surface.normal) * vec3(r * cos(angle), r * sin(angle), sqrt(max(1.0 - u.x, 0.0)));
    return Bounce(l, dot(l, h.face) > 0.0 ? h.surface.albedo : vec3(0.0));
}

// Heitz 2018, "Sampling the GGX Distribution of Visible Normals".
Bounce specularBounce(SurfaceHit h, vec2 u) {
    Surface s = h.surface;
    mat3 frame = frameOf(s.normal);
    vec3 v = h.view * frame;
    v = normalize(vec3(v.xy, max(v.z, 1e-4))); // mapped normals may face away
    float alpha = ggxAlpha(s.roughness);
    vec3 stretched = normalize(vec3(alpha * v.xy, v.z));
    float side2 = dot(stretched.xy, stretched.xy);
    vec3 x = side2 > 0.0 ? vec3(-stretched.y, stretched.x, 0.0) * inversesqrt(side2) : vec3(1, 0, 0);
    vec3 y = cross(stretched, x);
    float r = sqrt(u.x), angle = 2.0 * PI * u.y;
    vec2 t = r * vec2(cos(angle), sin(angle));
    float blend = 0.5 * (1.0 + stretched.z);
    t.y = mix(sqrt(max(1.0 - t.x * t.x, 0.0)), t.y, blend);
    vec3 n = t.x * x + t.y * y + sqrt(max(1.0 - dot(t, t), 0.0)) * stretched;
    vec3 half_way = normalize(vec3(alpha * n.xy, max(n.z, 0.0)));
    vec3 local = reflect(-v, half_way);
    vec3 l = frame * local;
    if (local.z <= 0.0 || dot(l, h.face) <= 0.0) return Bounce(l, vec3(0.0));
    float a2 = alpha * alpha;
    float g1 = 2.0 * v.z / (v.z + sqrt(a2 + (1.0 - a2) * v.z * v.z));
    if (SHADING_MODEL == SHADING_MODEL_BLINN_PHONG) {
        float density = g1 * distribution(half_way.z, s.roughness) / (4.0 * v.z);
        return Bounce(l, specularBrdf(s, frame * v, l) * local.z / max(density, 1e-20));
    }
    // D is in the BRDF and in the density, g1 D / (4 n.v), and cancels.
    return Bounce(l, fresnel(s.f0, dot(v, half_way)) * visibility(local.z, v.z, s.roughness) * 4.0 * local.z * v.z / g1);
}

float luminance(vec3 c) {
    return dot(c, vec3(0.2126, 0.7152, 0.0722));
}

// Radiance that arrives at p along -d after at most params.bounces turns, this ray being the first.
vec3 incoming(vec3 p, vec3 d, inout Random random, out bool escaped) {
    vec3 sum = vec3(0.0), weight = vec3(1.0);
    escaped = false;
    for (int bounce = 1; bounce <= params.bounces; bounce++) {
        Ray ray = Ray(p, d, 1e30);
        Hit hit = traceRay(ray, NO_FOOTPRINT, false);
        if (hit.triangle == NO_HIT) {
            escaped = bounce == 1;
            return sum + weight * sceneInfo.sky;
        }
        SurfaceHit h = surfaceOf(hit, ray, NO_FOOTPRINT);
        sum += weight * (h.emission + directLight(h.surface, h.position, h.face, h.view));
        if (bounce == params.bounces) break;
        vec4 u = next4(random);
        float shine = luminance(fresnel(h.surface.f0, max(dot(h.surface.normal, h.view), 0.0)));
        float chance = clamp(shine / max(shine + luminance(h.surface.albedo), 1e-6), 0.05, 0.95);
        Bounce next;
        if (u.z < chance) {
            next = specularBounce(h, u.xy);
            next.weight /= chance;
        } else {
            next = diffuseBounce(h, u.xy);
            next.weight /= 1.0 - chance;
        }
        weight *= next.weight;
        if (weight == vec3(0.0)) break;
        if (bounce > 3) { // Russian roulette (Arvo and Kirk 1990)
            float survival = clamp(max(weight.r, max(weight.g, weight.b)), 0.05, 1.0);
            if (u.w >= survival) break;
            weight /= survival;
        }
        p = offsetPoint(h.position, h.face);
        d = next.direction;
    }
    return sum;
}

vec3 cameraRay(vec2 at) {
    vec2 q = (2.0 * at / vec2(camera.size) - 1.0) * tan(0.5 * camera.fov_y);
    vec3 right = cross(camera.direction, camera.up);
    return normalize(camera.direction + q.x * float(camera.size.x) / float(camera.size.y) * right - q.y * camera.up);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    uint number = uint(params.first_sample) + pass.index;
    Random random = Random(uvec4(uint(pixel.x) | uint(pixel.y) << 16, number, 0, uint(params.seed)));
    vec4 u = next4(random);
    vec2 at = vec2(pixel) + (params.pixel == PIXEL_BOX ? u.xy : vec2(0.5));
    vec3 d = cameraRay(at);
    // The rasteriser's near plane cuts here too.
    vec3 start = camera.position + d * (camera.near / dot(d, camera.direction));
    Footprint f = Footprint(camera.position, cameraRay(at + vec2(1, 0)), cameraRay(at + vec2(0, 1)));
    Ray ray = Ray(start, d, 1e30);
    Hit hit = traceRay(ray, f, false);

    vec3 total = sceneInfo.sky, direct = vec3(0.0), diffuse = vec3(0.0), specular = vec3(0.0);
    float open = 1.0;
    if (hit.triangle != NO_HIT) {
        SurfaceHit h = surfaceOf(hit, ray, f);
        vec3 p = offsetPoint(h.position, h.face);
        direct = directLight(h.surface, h.position, h.face, h.view);
        vec4 v = next4(random);
        Bounce one = diffuseBounce(h, v.xy), two = specularBounce(h, v.zw);
        // Numbers of its own: a path does not depend on how long the other one is.
        Random other = Random(uvec4(random.key.xy, 1u << 16, random.key.w));
        bool sky = false, unused;
        // Its own albedo is left out of the test: black surfaces too have openness.
        if (dot(one.direction, h.face) > 0.0) diffuse = one.weight * incoming(p, one.direction, random, sky);
        open = sky ? 1.0 : 0.0;
        if (two.weight != vec3(0.0)) specular = two.weight * incoming(p, two.direction, other, unused);
        total = h.emission + direct + diffuse + specular;
    }
    if (any(isnan(total)) || any(isinf(total))) {
        atomicAdd(referenceErrors.not_finite, 1u);
        return;
    }
    ivec3 texel = ivec3(pixel, int(number & 1u));
    imageStore(totalSum, texel, imageLoad(totalSum, texel) + vec4(total, 1.0));
    imageStore(directSum, texel, imageLoad(directSum, texel) + vec4(direct, 1.0));
    imageStore(diffuseSum, texel, imageLoad(diffuseSum, texel) + vec4(diffuse, 1.0));
    imageStore(specularSum, texel, imageLoad(specularSum, texel) + vec4(specular, 1.0));
    imageStore(occlusionSum, texel, imageLoad(occlusionSum, texel) + vec4(vec3(open), 1.0));
}
