#version 460
#extension GL_GOOGLE_include_directive : require
// Pixels whose turn it is not keep what they have gathered, looked up where it was seen last. Those that have nothing are listed, and
// those off the lattice that gather for themselves when it is their turn.
#include "params.glsl"
#include "shade/turns.glsl"
#include "shade/kept.glsl"
#include "shade/filter.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform writeonly image2D gatheredDiffuse;
uniform writeonly image2D gatheredSpecular;

// Mirrors show what moves: smoother surfaces than this gather their reflections in every frame.
const float KEPT_ROUGHNESS = 0.1;

shared uint listed_here;
shared uint first;

// What a pixel gathers for itself.
struct Own {
    bool diffuse;
    bool specular;
};

// Where there is something to keep: in this pixel's own place, or in the lattice around.
bool findKept(ivec2 pixel, GBufferSurface seen, bool of_lattice, Own own, out ivec2 at) {
    if (!of_lattice && seenBefore(pixel, seen, 1, at) && texelFetch(lastSpecular, at, 0).a >= 0.0
        && (!own.diffuse || texelFetch(lastDiffuse, at, 0).a >= 0.0)) return true;
    return seenBefore(pixel, seen, params.ray_step, at);
}

// Keeps what there is, and says how the pixel must gather, if it must.
bool gathers(ivec2 pixel, out uint how) {
    uint number = pixelNumber(uvec2(pixel));
    bool of_lattice = isOfLattice(number), due = isDue(number);
    how = GATHER_FEW;
    if (of_lattice && due) return false; // others do
    GBufferSurface seen = gbufferAt(pixel);
    Own own = Own(of_lattice, params.specular_cone);
    if (seen.any && !of_lattice) {
        own.diffuse = isAlone(pixel, seen);
        own.specular = params.specular_cone && (own.diffuse || blurs(seen) < 1.0);
    }
    if (!seen.any || !own.diffuse && !own.specular) {
        imageStore(gatheredDiffuse, pixel, vec4(0.0, 0.0, 0.0, seen.any ? NOT_GATHERED : 1.0));
        imageStore(gatheredSpecular, pixel, vec4(0.0, 0.0, 0.0, seen.any ? NOT_GATHERED : 0.0));
        return false;
    }
    if (!own.diffuse) imageStore(gatheredDiffuse, pixel, vec4(0.0, 0.0, 0.0, NOT_GATHERED));
    ivec2 at;
    bool kept = !due && findKept(pixel, seen, of_lattice, own, at);
    float age = kept ? ageAt(at) : 0.0;
    // A surface may move over the picture in step with the turns, and never be where it is one's turn.
    if (due || kept && age > float(params.turns)) how = GATHER_ALL;
    else if (kept) how = GATHER_MIRRORED;
    if (!own.diffuse && how != GATHER_MIRRORED) how = GATHER_LOBE;
    if (how != GATHER_MIRRORED) return true;
    if (own.diffuse) imageStore(gatheredDiffuse, pixel, texelFetch(lastDiffuse, at, 0));
    imageStore(gatheredSpecular, pixel, vec4(texelFetch(lastSpecular, at, 0).rgb, age));
    return params.specular_cone && seen.surface.roughness < KEPT_ROUGHNESS;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (gl_LocalInvocationIndex == 0) listed_here = 0;
    barrier();
    uint how, place = 0;
    bool listed = all(lessThan(pixel, ivec2(camera.size))) && gathers(pixel, how);
    if (listed) place = atomicAdd(listed_here, 1);
    barrier();
    if (gl_LocalInvocationIndex == 0 && listed_here > 0) {
        first = atomicAdd(gatherCounter.count, listed_here);
        atomicMax(gatherCounter.groups.x, min((first + listed_here + 31) / 32, 65535u));
    }
    barrier();
    if (listed) gatherList.pixels[first + place] = uint(pixel.x) | uint(pixel.y) << 15 | how << 30;
}
