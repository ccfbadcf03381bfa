// Light gathered by a set of cones per pixel, in thesis.ron (thesis, Section 4.5.2). The including module of
// modules/trace defines vec4 traceAny(ConeOrigin o, vec3 d, float tan_half, int steps, uint number).
#include "cones/sets.glsl"
#include "gather/radiance.glsl"
#include "modules/specular_lobe.glsl"

vec4 gatherDiffuse(ConeOrigin o, vec3 n) {
    ConeSet set = diffuseConeSet();
    mat3 frame = frameOf(n);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < set.count; i++) {
        float angle = 2.0 * PI * float(i) / float(set.count - 1);
        vec3 d = i == 0
            ? n
            : frame * vec3(set.sin_tilt * cos(angle), set.sin_tilt * sin(angle), set.cos_tilt);
        float weight = i == 0 ? set.axial_weight : (1.0 - set.axial_weight) / float(set.count - 1);
        CONE_BEGINS(uint(i) + 1u);
        vec4 cone = traceAny(o, d, set.tan_half, params.diffuse_steps, uint(i) + 1u);
        sum += weight * vec4(coneRadiance(cone, d, coneSolidAngle(set.tan_half)), 1.0 - cone.a);
    }
    return sum;
}

vec3 gatherSpecular(ConeOrigin o, Surface s, vec3 face, vec3 v) {
    vec3 d = specularDirection(s, v);
    d = normalize(d + face * max(0.02 - dot(d, face), 0.0)); // mapped normals may reflect into the surface
    CONE_BEGINS(0u);
    float tan_half = tan(specularHalfAngle(s));
    return coneRadiance(traceAny(o, d, tan_half, params.specular_steps, 0u), d, coneSolidAngle(tan_half))
        * specularWeight(s, v);
}

// Two calls that trace cones: the compiler makes a separate, faster loop for each.
Gathered gather(ConeOrigin o, Surface s, vec3 face, vec3 v) {
    return Gathered(gatherDiffuse(o, s.normal), gatherSpecular(o, s, face, v));
}
