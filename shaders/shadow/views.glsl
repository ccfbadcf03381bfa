// Where lights look from: a directional or spot light once, over all that it lights, a point light six times.
#ifndef SHADOW_VIEWS_GLSL
#define SHADOW_VIEWS_GLSL

struct ShadowView {
    mat4 view_projection;
    mat4 inverse_view_projection;
    vec3 texel_size_and_depth; // x: world width of the map (at unit distance if perspective); z: 1 if perspective
    uint light;
};

layout(std430) readonly buffer ShadowViews { ShadowView views[]; } shadowViews;

#endif
