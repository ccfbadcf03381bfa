#version 460
#extension GL_GOOGLE_include_directive : require
// Draws a slice of the volume over the picture: a line where it cuts the visible surface, and a tint with a
// border where it is in front of it. Exact for boxes; on curved cells the view ray may cross it only once.
#include "params.glsl"
#include "common/scene.glsl"
#include "common/view_ray.glsl"
#include "volume/volume.glsl"

layout(location = 0) out vec4 display;

uniform sampler2D seenDepth;

const vec3 COLOR = vec3(1.0, 0.62, 0.1);
const float FAR = 1e4; // stands for infinity behind the background [m]

// The visible point of a pixel.
vec3 seenPoint(vec2 at, float depth) {
    if (depth <= 0.0) return camera.position + FAR * viewRay(at);
    vec2 ndc = 2.0 * at / vec2(camera.size) - 1.0;
    vec4 p = camera.inverse_view_projection * vec4(ndc, depth, 1.0);
    return p.xyz / p.w;
}

// Opacity of the slice at `position` along an axis of a map, in front of `seen`.
float opacityOf(VolumeMap map, vec3 seen, int axis, float position) {
    float cell = 1.0 / float(params.voxel_dim);
    vec3 end = worldToVolume(map, seen);
    if (inVolume(end) && abs(end[axis] - position) < 0.5 * cell) return 0.8;
    float from = 0.0, to = 1.0;
    bool below = worldToVolume(map, camera.position)[axis] < position;
    if (below == (end[axis] < position)) return 0.0;
    // Bisection: under a warp the crossing is not linear along the ray.
    for (int i = 0; i < 24; i++) {
        float middle = 0.5 * (from + to);
        bool is_before = (worldToVolume(map, mix(camera.position, seen, middle))[axis] < position) == below;
        if (is_before) from = middle;
        else to = middle;
    }
    vec3 crossing = worldToVolume(map, mix(camera.position, seen, from));
    crossing[axis] = 0.5;
    if (!inVolume(crossing)) return 0.0;
    vec3 rim = min(crossing, 1.0 - crossing);
    return min(rim.x, min(rim.y, rim.z)) < 0.5 * cell ? 0.8 : 0.2;
}

void main() {
    float depth = texelFetch(seenDepth, ivec2(gl_FragCoord.xy), 0).r;
    vec3 seen = seenPoint(gl_FragCoord.xy, depth);
    int axis = clamp(int(params.slice.x), 0, 2);
    float stored = params.slice.y * (axis == 2 ? float(CASCADE_COUNT) : 1.0), opacity = 0.0;
    for (int k = 0; k < CASCADE_COUNT; k++) {
        float position = axis == 2 ? stored - float(k) : stored;
        if (position >= 0.0 && position < 1.0)
            opacity = max(opacity, opacityOf(volume.maps[k], seen, axis, position));
    }
    display = vec4(COLOR, opacity);
}
