// The light that a surface's cones gather (thesis, Section 4.5.2).
// With CONE_RECORD defined, recordCone(number) is called before each cone: 0 is the specular one, 1 the
// diffuse one on the normal, then the ring.
#ifndef GATHER_GLSL
#define GATHER_GLSL
#include "scene.glsl"
#include "brdf.glsl"
#include "cone_sets.glsl"
#include "frame.glsl"
#ifdef VOXEL_RAYS
#include "exact.glsl"
#include "ggx.glsl"
#else
#include "cone.glsl"
#endif

uniform sampler2D specularAlbedo; // of the lobe, from specular_albedo.comp

// Centre of the pixel that is shaded: defined by the shader.
vec2 pixelCentre();

// What a cone contributes: its radiance, the sky where it escaped, and the thesis's occlusion factor.
vec3 coneRadiance(vec4 cone) {
    vec3 l = cone.rgb;
    if (params.cone_sky) l += (1.0 - cone.a) * sceneInfo.sky;
    return params.multiply_occlusion == MULTIPLY_OCCLUSION_NONE ? l : l * (1.0 - cone.a);
}

vec4 traceAny(ConeOrigin o, vec3 d, float tan_half, int steps, uint number) {
#ifdef VOXEL_RAYS
    return traceExactCone(o, d, tan_half, number);
#else
    return traceCone(o, d, tan_half, steps);
#endif
}

#ifdef VOXEL_RAYS
// Without cones: rays over the whole hemisphere, as dense as the cosine.
vec4 diffuseRays(ConeOrigin o, vec3 n, vec3 face) {
    mat3 frame = frameOf(n);
    vec2 shift = exactShift(1u);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < params.exact_rays; i++) {
        vec3 d = frame * cosineSample(exactPoint(i, shift));
        if (dot(d, face) <= 0.0) continue;
        vec4 ray = traceVoxels(o.position, d);
        sum += vec4(coneRadiance(ray), 1.0 - ray.a);
    }
    return sum / float(params.exact_rays);
}

// Without a cone: rays as dense as the visible normals of the lobe.
vec3 specularRays(ConeOrigin o, Surface s, vec3 face, vec3 v) {
    vec2 shift = exactShift(0u);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < params.exact_rays; i++) {
        LobeSample l = specularSample(s, face, v, exactPoint(i, shift));
        if (l.weight != vec3(0.0)) sum += l.weight * coneRadiance(traceVoxels(o.position, l.direction));
    }
    return sum / float(params.exact_rays);
}

#endif

// What a surface's cones gather.
struct Gathered {
    vec4 hemisphere; // rgb: mean radiance over the hemisphere, cosine-weighted; a: how open it is
    vec3 specular; // radiance towards the viewer
};

// Of the cone that stands for the specular lobe: w is the tangent of half its angle.
vec4 specularCone(Surface s, vec3 face, vec3 v) {
    float alpha = ggxAlpha(s.roughness);
    vec3 d = reflect(-v, s.normal);
    // Where a rough lobe's weight lies: between the mirror direction and the normal (Lagarde and de Rousiers 2014,
    // Section 4.9.3, with Smith's term).
    if (params.specular_axis == SPECULAR_AXIS_DOMINANT) {
        d = normalize(mix(s.normal, d, (1.0 - alpha) * (sqrt(1.0 - alpha) + alpha)));
    }
    d = normalize(d + face * max(0.02 - dot(d, face), 0.0)); // mapped normals may reflect into the surface
    // Half of a GGX lobe lies within 2 atan(alpha) of the mirror direction; the thesis takes 0.1 pi roughness
    // for the whole aperture.
    float half_angle = params.specular_aperture == SPECULAR_APERTURE_THESIS ? 0.05 * PI * s.roughness
                                                                            : min(2.0 * atan(alpha), PI / 3.0);
    return vec4(d, tan(half_angle));
}

// How much of the specular cone's radiance goes to the viewer.
vec3 specularWeight(Surface s, vec3 v) {
    if (params.specular_weight == SPECULAR_WEIGHT_PLAIN) return vec3(1.0); // as the thesis adds it
    vec2 albedo = textureLod(specularAlbedo, (vec2(sqrt(max(dot(s.normal, v), 0.0)), s.roughness) * 31.0 + 0.5) / 32.0, 0.0).rg;
    return s.f0 * albedo.r + albedo.g;
}

// One loop over all cones, the specular one last: the compiler copies what traces them once for each place that it
// is called from, and a researcher waits for that at every save.
Gathered gather(ConeOrigin o, Surface s, vec3 face, vec3 v) {
    vec3 n = params.cone_normal == CONE_NORMAL_MAPPED ? s.normal : face;
#ifdef VOXEL_RAYS
    if (TRACE == TRACE_LOBE_RAYS)
        return Gathered(diffuseRays(o, n, face), params.specular_cone ? specularRays(o, s, face, v) : vec3(0.0));
#endif
    ConeSet set = diffuseCones();
    mat3 frame = frameOf(n);
    float turn = 0.0;
    if (params.cone_rotate) // interleaved gradient noise (Jimenez 2014): trades banding for noise
        turn = fract(52.9829189 * fract(dot(pixelCentre(), vec2(0.06711056, 0.00583715))));
    vec4 mirror = specularCone(s, face, v);
    Gathered sum = Gathered(vec4(0.0), vec3(0.0));
    int cones = set.count + (params.specular_cone ? 1 : 0);
    for (int i = 0; i < cones; i++) {
        bool specular = i == set.count;
        float angle = 2.0 * PI * (float(i) + turn) / float(set.count - 1);
        vec3 d = i == 0 ? n : frame * vec3(set.sin_tilt * cos(angle), set.sin_tilt * sin(angle), set.cos_tilt);
        float weight = i == 0 ? set.axial_weight : (1.0 - set.axial_weight) / float(set.count - 1);
        uint number = specular ? 0u : uint(i) + 1u;
#ifdef CONE_RECORD
        recordCone(number);
#endif
        vec4 cone = traceAny(o, specular ? mirror.xyz : d, specular ? mirror.w : set.tan_half,
            specular ? params.specular_steps : params.diffuse_steps, number);
        vec3 l = coneRadiance(cone);
        if (specular) sum.specular = l * specularWeight(s, v);
        else sum.hemisphere += weight * vec4(l, 1.0 - cone.a);
    }
    return sum;
}

#endif
