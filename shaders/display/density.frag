#version 460
#extension GL_GOOGLE_include_directive : require
// Colours the scene by the density of its voxels (thesis, Figure 5.7).
#include "params.glsl"
#include "common/scene.glsl"
#include "volume/volume.glsl"
#include "display/density.glsl"

layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 inspected;

uniform sampler2D seenDepth;
uniform sampler2D surfaceNormal;

const float NOTHING = 1e-30; // background depth, above 0 to keep positions finite

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float z = max(texelFetch(seenDepth, pixel, 0).r, NOTHING);
    vec4 h = camera.inverse_view_projection * vec4(uv * 2.0 - 1.0, z, 1.0);
    vec3 p = h.xyz / h.w;
    vec3 n = texelFetch(surfaceNormal, pixel, 0).rgb * 2.0 - 1.0;
    float light = 0.35 + 0.65 * abs(dot(n, normalize(camera.position - p)));
    int cascade = cascadeAt(p);
    vec3 u = worldToVolume(volume.maps[cascade], p);
    inspected = vec4(z > NOTHING && inVolume(u) ?
        densityColor(volume.maps[cascade], p) * light : vec3(0.0), 1.0);
}
