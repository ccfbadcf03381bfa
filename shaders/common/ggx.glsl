// Importance sampling of the BRDF's lobes.
#ifndef GGX_GLSL
#define GGX_GLSL
#include "common/brdf.glsl"
#include "common/frame.glsl"

// A direction, and BRDF * cosine / pdf. If the weight is 0, the direction is invalid.
struct LobeSample {
    vec3 direction;
    vec3 weight;
};

// A direction around z with pdf cosine / pi. u: two numbers in [0, 1).
vec3 cosineSample(vec2 u) {
    float r = sqrt(u.x), angle = 2.0 * PI * u.y;
    return vec3(r * cos(angle), r * sin(angle), sqrt(max(1.0 - u.x, 0.0)));
}

// Smith's masking of a direction at this cosine from the normal.
float maskingOf(float cosine, float alpha) {
    float a2 = alpha * alpha;
    return 2.0 * cosine / (cosine + sqrt(a2 + (1.0 - a2) * cosine * cosine));
}

// Heitz 2018, "Sampling the GGX Distribution of Visible Normals". face: the triangle's normal on the viewer's
// side. Directions below it get weight 0.
LobeSample specularSample(Surface s, vec3 face, vec3 view, vec2 u) {
    mat3 frame = frameOf(s.normal);
    vec3 v = view * frame;
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
    if (local.z <= 0.0 || dot(l, face) <= 0.0) return LobeSample(l, vec3(0.0));
    return LobeSample(l, lobeWeight(s, frame, v, local, half_way, maskingOf(v.z, alpha)));
}

// Pdfs of cosineSample around the normal and of specularSample at l [1/sr].
float diffuseDensity(Surface s, vec3 l) {
    return max(dot(s.normal, l), 0.0) / PI;
}

float specularDensity(Surface s, vec3 view, vec3 l) {
    float n_v = max(dot(s.normal, view), 1e-4);
    return maskingOf(n_v, ggxAlpha(s.roughness))
        * distribution(max(dot(s.normal, normalize(view + l)), 0.0), s.roughness) / (4.0 * n_v);
}

#endif
