// A few narrow cones or rays a pixel, other ones in each pixel of a block of 8x8 that traces any: shading filters over the block, so
// that each surface sees up to 64 times as many (Segovia et al. 2006). What traces one is in modules/trace, which includes this after
// saying: vec4 traceAny(ConeOrigin o, vec3 d, float tan_half, int steps).
#include "cones/light.glsl"
#include "common/ggx.glsl"
#include "common/pattern.glsl"

// Point of the pixel's pattern; those of a pixel lie far apart, and those of neighbours too.
vec2 pixelPoint(int i) {
    return evenPoint(uint(i) * uint(params.ray_patterns) + pixelNumber(uvec2(pixelCentre())));
}

// The same, other ones in each block: what few directions cannot tell becomes noise and not a bias.
vec2 blockPoint(int i) {
    uvec2 block = uvec2(pixelCentre()) >> 3;
    return fract(pixelPoint(i) + evenPoint(block.x * 37u + block.y * 101u));
}

// A cone has the share of the hemisphere that it has among those of 4x4 pixels, unless diffuse_aperture says otherwise: narrower
// ones would take more steps and tell no more.
float tanOfShare(int cones) {
    if (params.diffuse_aperture > 0.0) return tan(radians(0.5 * params.diffuse_aperture));
    float cosine = 1.0 - 1.0 / float(16 * cones);
    return sqrt(1.0 - cosine * cosine) / cosine;
}

float largest(vec3 v) {
    return max(v.r, max(v.g, v.b));
}

// Rays into the lobe, beside those over the hemisphere: by its share of the light that the surface reflects.
int specularRays(Surface s, vec3 v) {
    float mirrored = largest(fresnel(s.f0, max(dot(s.normal, v), 0.0)));
    float share = mirrored / (mirrored + largest(s.albedo));
    return clamp(int(ceil(params.lobe_share * share * float(gatherShare.lobe))), 1, max(gatherShare.lobe, 1));
}

// Cones over the hemisphere, then some directions of the lobe; a cone there has a sixteenth of it. One loop for both: what traces them is
// large, and in the program once.
Gathered gather(ConeOrigin o, Surface s, vec3 face, vec3 v) {
    mat3 frame = frameOf(s.normal);
    float tan_half = tanOfShare(params.pixel_cones), tan_lobe = 0.5 * ggxAlpha(s.roughness);
    int rays = gatherShare.rays, lobe = params.specular_cone ? specularRays(s, v) : 0;
    // What each of them stands for.
    float spread = PI / float(max(rays, 1)), lobe_spread = lobeSolidAngle(s) / float(max(lobe, 1));
    vec4 hemisphere = vec4(0.0);
    vec3 specular = vec3(0.0);
    for (int i = gatherShare.first; i < rays + lobe; i += gatherShare.of) {
        bool mirrors = i >= rays;
        vec3 d, weight = vec3(0.0);
        if (mirrors) {
            LobeSample l = specularSample(s, face, v, blockPoint(i - rays));
            d = l.direction;
            weight = l.weight;
            if (weight == vec3(0.0)) continue;
        } else {
            d = frame * cosineSample(pixelPoint(i));
            if (dot(d, face) <= 0.0) continue; // mapped normals lean
        }
        CONE_BEGINS(!mirrors ? uint(i) + 1u : i == rays ? 0u : uint(params.diffuse_cones + i - rays));
        vec4 cone = traceAny(o, d, mirrors ? tan_lobe : tan_half, mirrors ? params.specular_steps : params.diffuse_steps);
        vec3 light = coneRadiance(cone, d, mirrors ? lobe_spread : spread);
        if (mirrors) specular += weight * light;
        else hemisphere += vec4(light, 1.0 - cone.a);
    }
    return Gathered(hemisphere / float(max(rays, 1)), specular / float(max(lobe, 1)));
}
