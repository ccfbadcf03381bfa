#version 460
#extension GL_GOOGLE_include_directive : require
// Draws the recorded cones over the image: for each sample the line that leads to it, and the outline of the
// cell that it read if that was not empty. Colour shows the level, opacity the sample's weight.
#include "params.glsl"
#include "common/scene.glsl"
#include "volume/volume.glsl"
#include "probe/samples.glsl"

layout(location = 0) flat out vec4 color;
layout(location = 1) out float across; // signed distance from the line's centre [pixels]
layout(location = 2) flat out float half_width; // [pixels]

const vec4 NOWHERE = vec4(0.0, 0.0, -1.0, 1.0);

// Green for the finest level, then blue, violet and red.
vec3 levelColor(float level) {
    float hue = 0.36 + 0.09 * level;
    vec3 pure = clamp(abs(fract(hue + vec3(1.0, 2.0 / 3.0, 1.0 / 3.0)) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
    return mix(pure, vec3(1.0), 0.2);
}

// Corner of the quad for a line from a to b (clip space). Extends `half_width` plus half a pixel to each
// side.
vec4 lineCorner(vec4 a, vec4 b, int corner) {
    float least = camera.near;
    if (a.w < least && b.w < least) return NOWHERE;
    vec4 from = a.w < least ? mix(b, a, (b.w - least) / (b.w - a.w)) : a;
    vec4 to = b.w < least ? mix(a, b, (a.w - least) / (a.w - b.w)) : b;
    vec3 p = from.xyz / from.w, q = to.xyz / to.w;
    vec2 pixels = 0.5 * vec2(camera.size);
    vec2 d = (q.xy - p.xy) * pixels;
    d = dot(d, d) > 1e-8 ? normalize(d) : vec2(1.0, 0.0);
    across = (corner & 1) == 0 ? half_width + 0.5 : -half_width - 0.5;
    vec3 at = corner < 2 ? p : q;
    return vec4(at.xy + vec2(-d.y, d.x) * across / pixels, at.z, 1.0);
}

void main() {
    const int corners[6] = int[6](0, 1, 2, 2, 1, 3);
    RecordedSample s = coneSamples.list[gl_InstanceIndex];
    int line = gl_VertexIndex / 6 - 1, corner = corners[gl_VertexIndex % 6];
    vec3 a, b;
    if (line < 0) {
        a = s.number == 0 ? coneSamples.surface : coneSamples.list[gl_InstanceIndex - 1].position;
        b = s.position;
        half_width = s.cone == 0 ? 1.75 : 1.0;
        color = vec4(mix(levelColor(s.level), vec3(1.0), 0.4), 0.25 + 0.75 * (s.transmittance + s.alpha));
    } else {
        // Edge along an axis, at one of the four corners of the other two axes.
        int axis = line / 4;
        vec3 at = vec3(-0.5);
        at[(axis + 1) % 3] += float(line & 1);
        at[(axis + 2) % 3] += float(line >> 1 & 1);
        mat3 cell = cellAxes(volume.maps[cascadeAt(s.position)], s.position) * exp2(s.level);
        a = s.position + cell * at;
        b = a + cell[axis];
        half_width = 0.75;
        color = vec4(levelColor(s.level), sqrt(clamp(s.alpha, 0.0, 1.0)));
    }
    gl_Position = lineCorner(camera.view_projection * vec4(a, 1.0), camera.view_projection * vec4(b, 1.0),
        corner);
    if (color.a < 0.01) gl_Position = NOWHERE;
}
