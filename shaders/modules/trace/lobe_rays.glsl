// Rays through every voxel over the whole lobe, without cones.
#include "cones/cone_origin.glsl"
#include "surfels/rays.glsl"
#include "gather/radiance.glsl"
#include "common/ggx.glsl"

// Samples with a pdf proportional to the cosine.
vec4 gatherDiffuse(ConeOrigin o, vec3 n, vec3 face) {
    mat3 frame = frameOf(n);
    vec2 shift = rayShift(1u);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < params.exact_rays; i++) {
        vec3 d = frame * cosineSample(rayPoint(i, shift));
        if (dot(d, face) <= 0.0) continue;
        vec4 ray = traceVoxels(o, d, WHOLE_RAY);
        sum += vec4(coneRadiance(ray, d, PI / float(params.exact_rays)), 1.0 - ray.a);
    }
    return sum / float(params.exact_rays);
}

// Samples the visible normals of the lobe.
vec3 gatherSpecular(ConeOrigin o, Surface s, vec3 face, vec3 v) {
    vec2 shift = rayShift(0u);
    float spread = lobeSolidAngle(s) / float(params.exact_rays);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < params.exact_rays; i++) {
        LobeSample l = specularSample(s, face, v, rayPoint(i, shift));
        if (l.weight != vec3(0.0))
            sum += l.weight * coneRadiance(traceVoxels(o, l.direction, WHOLE_RAY), l.direction, spread);
    }
    return sum / float(params.exact_rays);
}

Gathered gather(ConeOrigin o, Surface s, vec3 face, vec3 v) {
    return Gathered(gatherDiffuse(o, s.normal, face), gatherSpecular(o, s, face, v));
}
