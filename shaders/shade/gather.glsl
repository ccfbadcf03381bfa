// What the rays or cones of each pixel gather, to be filtered and reflected by shading. Groups of threads have one pixel of each of
// 8x8 blocks, the same one: their rays go the same ways, which caches and branches like, and what does not gather ends as a whole.
#include "common/gbuffer_read.glsl"
#include "common/pattern.glsl"
#include "modules/trace.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform writeonly image2D gatheredDiffuse; // mean radiance over the hemisphere; a: how open it is
uniform writeonly image2D gatheredSpecular; // radiance towards the viewer; a: age [frames]

// What a pixel gathers, or has kept for `age` frames: defined by the shader.
Gathered gatherOrKeep(ivec2 pixel, GBufferSurface seen, ConeOrigin o, out float age);

// The number of the pixels of each block that come first.
uint firstNumber();

ivec2 gatheringPixel() {
    uvec2 id = gl_GlobalInvocationID.xy;
    if (params.pattern == 1) return ivec2(id);
    uvec2 blocks = (camera.size + 7u) / 8u, part = id / blocks;
    return ivec2(id % blocks * 8u + pixelOfNumber(firstNumber() + part.y * 8u + part.x & 63u));
}

vec2 pixelCentre() {
    return vec2(gatheringPixel()) + 0.5;
}

void main() {
    ivec2 pixel = gatheringPixel();
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    GBufferSurface seen = gbufferAt(pixel);
    Gathered light = Gathered(vec4(0.0, 0.0, 0.0, 1.0), vec3(0.0));
    float age = 0.0;
    if (seen.any) light = gatherOrKeep(pixel, seen, coneOrigin(seen.position, seen.face, seen.surface.normal), age);
    imageStore(gatheredDiffuse, pixel, light.hemisphere);
    imageStore(gatheredSpecular, pixel, vec4(light.specular, age));
}
