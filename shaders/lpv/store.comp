#version 460
#extension GL_GOOGLE_include_directive : require
// The sum of all waves, for lookups between cells.
#include "params.glsl"
#include "lpv/grid.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430) readonly buffer LpvSums { vec4 coefficients[]; } lpvSums;
uniform writeonly image3D lpvRed;
uniform writeonly image3D lpvGreen;
uniform writeonly image3D lpvBlue;

void main() {
    ivec3 stored = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(stored.xy, ivec2(params.lpv_dim)))) return;
    uint own = 3u * indexIn(params.lpv_dim, stored, 0);
    imageStore(lpvRed, stored, lpvSums.coefficients[own]);
    imageStore(lpvGreen, stored, lpvSums.coefficients[own + 1]);
    imageStore(lpvBlue, stored, lpvSums.coefficients[own + 2]);
}
