// Sets up the layers of the shadow map: the lights' views, and for directional lights `nested_maps` - 1 cubes
// around the camera, each `shadow_step` times smaller than the one before. As in Zhang et al. 2006,
// "Parallel-Split Shadow Maps for Large-scale Virtual Environments", but around the eye: turning it moves no
// map.
#include "params.glsl"
#include "common/scene.glsl"
#include "shadow/views.glsl"
#define LAYER_WRITES
#include "shadow/layers.glsl"

layout(local_size_x = 1) in;

#ifdef NESTED_MAPS
// The direction that row i of a matrix measures along.
vec3 directionOf(mat4 m, int i) {
    return normalize(vec3(m[0][i], m[1][i], m[2][i]));
}

// A cube of this width around the camera, along the axes of a directional light's view. It moves by whole
// texels, so that shadows of static geometry do not change.
mat4 around(mat4 whole, float width) {
    float texel = width / float(params.shadow_dim);
    mat4 m = mat4(1.0);
    for (int i = 0; i < 3; i++) {
        vec3 axis = directionOf(whole, i);
        float middle = floor(dot(axis, camera.position) / texel) * texel;
        float scale = (i < 2 ? 2.0 : 1.0) / width; // x, y in [-1,1], depth in [0,1]
        m[0][i] = axis.x * scale;
        m[1][i] = axis.y * scale;
        m[2][i] = axis.z * scale;
        m[3][i] = (i < 2 ? 0.0 : 0.5) - middle * scale;
    }
    return m;
}

// Depth error of a surface as large as the scene, in a map of a small part of it [2^-24 of the whole
// view's width]: rasterisers clip and interpolate at the scale of the scene. Measured on an NVIDIA H100: 0.2.
const float ROUNDED_BITS = 0.5;

#endif

// Depth is clamped, so geometry in front of the near plane casts shadows too, down to a tenth of its
// distance. Orthographic views have w = 1 everywhere.
float nearOf(ShadowView view) {
    if (view.texel_size_and_depth.z == 0.0) return 0.5;
    mat4 m = transpose(view.view_projection); // z = scale * w - scale * near
    float scale = length(m[2].xyz) / length(m[3].xyz);
    return max(0.1 * (m[3].w - m[2].w / scale), 1e-7);
}

// Places a layer in the texture. A directional light has whole pages. Each view of a lamp has an equal square
// of a page, or a corner of its own page if the GPU's rasteriser draws it.
void placeIn(inout ShadowLayer layer, uint number, bool lamp, uint among) {
    uint rows = uint(params.lamp_rows), here = among % (rows * rows);
    layer.edge = lamp ? uint(params.shadow_dim) / rows : uint(params.shadow_dim);
    layer.page = params.shadow_threads == 0 ? number
        : lamp ? uint(params.whole_pages) + among / (rows * rows)
        : among;
    bool shares = lamp && params.shadow_threads == 1;
    layer.corner = shares ? layer.edge * (here % rows) | layer.edge * (here / rows) << 16 : 0u;
}

void main() {
    uint lamps = 0, wholes = 0;
#ifdef NESTED_MAPS
    int next = int(sceneInfo.shadow_views);
#endif
    for (uint i = 0; i < sceneInfo.light_count; i++) {
        Light light = lights.lights[i];
        if (light.shadow_view < 0) continue;
        int views = castsAround(light) ? 6 : 1;
        for (int layer = light.shadow_view; layer < light.shadow_view + views; layer++) {
            ShadowView view = shadowViews.views[layer];
            ShadowLayer l = ShadowLayer(view.view_projection, view.texel_size_and_depth.x,
                view.texel_size_and_depth.z, -1, 0.0, nearOf(view), 0, 0, 0);
            bool lamp = light.kind != LIGHT_DIRECTIONAL;
            placeIn(l, layer, lamp, lamp ? lamps++ : wholes++);
            shadowLayers.layers[layer] = l;
        }
#ifdef NESTED_MAPS
        if (light.kind != LIGHT_DIRECTIONAL) continue;
        ShadowView whole = shadowViews.views[light.shadow_view];
        int layer = light.shadow_view;
        float width = whole.texel_size_and_depth.x;
        for (int k = 1; k < params.nested_maps; k++) {
            width /= params.shadow_step;
            shadowLayers.layers[layer].finer = next;
            ShadowLayer l = ShadowLayer(around(whole.view_projection, width), width, 0.0, -1,
                ROUNDED_BITS / 16777216.0 * whole.texel_size_and_depth.x / width, 0.5, 0, 0, 0);
            placeIn(l, next, false, wholes++);
            shadowLayers.layers[next] = l;
            layer = next++;
        }
#endif
    }
}
