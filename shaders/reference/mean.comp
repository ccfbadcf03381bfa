#version 460
#extension GL_GOOGLE_include_directive : require
// Means over the samples of both halves.
#include "params.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(rgba32f) uniform readonly image2DArray totalSum;
layout(rgba32f) uniform readonly image2DArray directSum;
layout(rgba32f) uniform readonly image2DArray diffuseSum;
layout(rgba32f) uniform readonly image2DArray specularSum;
layout(rgba32f) uniform readonly image2DArray occlusionSum;
uniform writeonly image2D radiance;
uniform writeonly image2D direct;
uniform writeonly image2D diffuse;
uniform writeonly image2D specular;
uniform writeonly image2D occlusion;

vec4 mean(vec4 even, vec4 odd) {
    vec4 sum = even + odd;
    return vec4(sum.rgb / max(sum.a, 1.0), 1.0);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(radiance)))) return;
    ivec3 even = ivec3(pixel, 0), odd = ivec3(pixel, 1);
    imageStore(radiance, pixel, mean(imageLoad(totalSum, even), imageLoad(totalSum, odd)));
    imageStore(direct, pixel, mean(imageLoad(directSum, even), imageLoad(directSum, odd)));
    imageStore(diffuse, pixel, mean(imageLoad(diffuseSum, even), imageLoad(diffuseSum, odd)));
    imageStore(specular, pixel, mean(imageLoad(specularSum, even), imageLoad(specularSum, odd)));
    imageStore(occlusion, pixel, mean(imageLoad(occlusionSum, even), imageLoad(occlusionSum, odd)));
}
