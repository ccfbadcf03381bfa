#version 460
#extension GL_GOOGLE_include_directive : require
// Pixels whose turn it is not keep what they have gathered, looked up where it was seen last. Those that have nothing are listed.
#include "params.glsl"
#include "shade/turns.glsl"
#include "shade/kept.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform writeonly image2D gatheredDiffuse;
uniform writeonly image2D gatheredSpecular;

// Mirrors show what moves: smoother surfaces than this gather their reflections in every frame.
const float KEPT_ROUGHNESS = 0.1;

shared uint listed_here;
shared uint first;

// Keeps what there is; false: the pixel must gather, and `how`.
bool keep(ivec2 pixel, out uint how) {
    GBufferSurface seen = gbufferAt(pixel);
    how = GATHER_FEW;
    ivec2 at = pixel;
    if (seen.any && !seenBefore(pixel, seen, at)) return false;
    float age = ageAt(at);
    // A surface may move over the picture in step with the turns, and never be where it is one's turn.
    how = GATHER_ALL;
    if (seen.any && age > float(params.turns)) return false;
    imageStore(gatheredDiffuse, pixel, seen.any ? texelFetch(lastDiffuse, at, 0) : vec4(0.0, 0.0, 0.0, 1.0));
    imageStore(gatheredSpecular, pixel, seen.any ? vec4(texelFetch(lastSpecular, at, 0).rgb, age) : vec4(0.0));
    how = GATHER_MIRRORED;
    return !(seen.any && params.specular_cone && seen.surface.roughness < KEPT_ROUGHNESS);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (gl_LocalInvocationIndex == 0) listed_here = 0;
    barrier();
    uint how, place = 0;
    bool listed = all(lessThan(pixel, ivec2(camera.size))) && !isDue(pixelNumber(uvec2(pixel))) && !keep(pixel, how);
    if (listed) place = atomicAdd(listed_here, 1);
    barrier();
    if (gl_LocalInvocationIndex == 0 && listed_here > 0) {
        first = atomicAdd(gatherCounter.count, listed_here);
        atomicMax(gatherCounter.groups.x, min((first + listed_here + 31) / 32, 65535u));
    }
    barrier();
    if (listed) gatherList.pixels[first + place] = uint(pixel.x) | uint(pixel.y) << 15 | how << 30;
}
