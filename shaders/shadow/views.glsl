// Views of the lights: one for a directional or spot light, covering all that it lights; six for any
// other.
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

// Area of a view's whole map [m^2], at unit distance if perspective. The map of a directional light need
// not be square.
float mapArea(ShadowView view) {
    float width = view.texel_size_and_depth.x;
    if (view.texel_size_and_depth.z > 0.0) return width * width;
    mat4 m = view.inverse_view_projection;
    return 4.0 * length(cross(m[0].xyz, m[1].xyz));
}

#endif
