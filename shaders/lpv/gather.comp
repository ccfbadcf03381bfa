#version 460
#extension GL_GOOGLE_include_directive : require
// Light of the pixels from the finest grid that holds them. Light that crosses a cell with an intensity I
// has the radiance I / (1.5 s^2): 1.5 s^2 is the mean area of a cube of edge s across a direction.
#include "params.glsl"
#include "gbuffer/read.glsl"
#include "lpv/grid.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler3D lpvRed;
uniform sampler3D lpvGreen;
uniform sampler3D lpvBlue;
uniform writeonly image2D gatheredDiffuse;

vec3 lightAt(vec3 p, vec3 n) {
    for (int grid = params.lpv_cascades - 1; grid >= 0; grid--) {
        vec3 at = (p - gridCorner(grid)) / cellEdge(grid) + 0.5 * n; // off the surface
        if (any(lessThan(at, vec3(1.0))) || any(greaterThan(at, vec3(params.lpv_dim - 1)))) continue;
        vec3 u = (at + vec3(0.0, 0.0, grid * params.lpv_dim)) / vec3(textureSize(lpvRed, 0));
        vec4 arriving = cosineLobe(-n) / (1.5 * PI);
        return max(arriving * mat3x4(textureLod(lpvRed, u, 0.0), textureLod(lpvGreen, u, 0.0),
            textureLod(lpvBlue, u, 0.0)), 0.0);
    }
    return vec3(0.0);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    GBufferSurface seen = gbufferAt(pixel);
    vec4 light = vec4(0.0, 0.0, 0.0, 1.0);
    if (seen.any) light.rgb = lightAt(seen.position, seen.surface.normal);
    imageStore(gatheredDiffuse, pixel, light);
}
