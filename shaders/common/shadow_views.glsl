// Where shadow maps look from.
#ifndef SHADOW_VIEWS_GLSL
#define SHADOW_VIEWS_GLSL
#include "common/lights.glsl"

struct ShadowView {
    mat4 view_projection;
    mat4 inverse_view_projection;
    vec3 texel_size_and_depth; // x: world width of the map (at unit distance if perspective); z: 1 if perspective
    uint light;
};

layout(std430) readonly buffer ShadowViews { ShadowView views[]; } shadowViews;

// Which of the six faces of a point light's shadow cube looks along d.
int cubeFace(vec3 d) {
    vec3 a = abs(d);
    if (a.x >= a.y && a.x >= a.z) return d.x >= 0.0 ? 0 : 1;
    if (a.y >= a.z) return d.y >= 0.0 ? 2 : 3;
    return d.z >= 0.0 ? 4 : 5;
}

int shadowViewOf(Light light, vec3 p) {
    return light.shadow_view + (light.kind == LIGHT_POINT ? cubeFace(p - light.position) : 0);
}

// World size of a shadow texel at p.
float shadowTexel(int view, Light light, vec3 p) {
    vec3 t = shadowViews.views[view].texel_size_and_depth;
    return t.x * (t.z > 0.0 ? distance(light.position, p) : 1.0) / float(params.shadow_dim);
}

// xy: shadow-map coordinates in [0,1]; z: depth, outside [0,1] beyond the map's ends.
vec3 shadowPositionBeyond(int view, vec3 p) {
    vec4 c = shadowViews.views[view].view_projection * vec4(p, 1.0);
    vec3 q = c.xyz / max(c.w, 1e-6); // a spot light's plane has w = 0; behind it no light arrives
    return vec3(q.xy * 0.5 + 0.5, q.z);
}

// The same, as the map has it.
vec3 shadowPosition(int view, vec3 p) {
    vec3 q = shadowPositionBeyond(view, p);
    return vec3(q.xy, clamp(q.z, 0.0, 1.0));
}

#endif
