// Views of the lights: one for a directional or spot light, covering all that it lights; six for any other.
#ifndef SHADOW_VIEWS_GLSL
#define SHADOW_VIEWS_GLSL

struct ShadowView {
    mat4 view_projection;
    mat4 inverse_view_projection;
    // x: world width of the map (at unit distance if perspective); z: 1 if perspective
    vec3 texel_size_and_depth;
    uint light;
};

layout(std430) readonly buffer ShadowViews { ShadowView views[]; } shadowViews;

#endif
