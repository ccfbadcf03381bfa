#version 460
#extension GL_GOOGLE_include_directive : require
// What pixels gathered before they keep, looked up where their surface was seen last, until it is as old as all turns are long. Those that
// gather are listed.
#include "params.glsl"
#include "shade/turns.glsl"
#include "shade/kept.glsl"
#include "common/ggx.glsl"

// Of a group: what it lists it sorts, so that rays of one kind which go the same ways are traced together.
const ivec2 REGION = ivec2(64, 32);
const uint THREADS = 256;
const uint EACH = 8; // pixels of a thread

layout(local_size_x = 256) in;

uniform writeonly image2D gatheredDiffuse;
uniform writeonly image2D gatheredSpecular;

// Mirrors show what moves: smoother surfaces than this gather their reflections in every frame.
const float KEPT_ROUGHNESS = 0.1;

const uint NOT_LISTED = 0xffffffffu;
const uint KINDS = 256; // a way to gather, and a number in the block

shared uint listed[EACH * THREADS]; // kind, and above it which of that kind
shared uint starts[KINDS];
shared uint first;

// What has gathered with few rays alone is not as old as what ages by whole frames, by so much.
const float OF_FEW = 0.5;

// Rounds of the voxels without a change until their light has all but settled: of light of which half comes back, less than a
// hundredth is missing.
const int SETTLED_ROUNDS = 8;

// Whether what is kept grows older in this frame. Under a moving camera settled light does so in one of a few frames: in the fewer, the
// less the surface's lobe turns in all turns.
bool ages(GBufferSurface seen, uint number, bool of_few) {
    // By then each pixel has gathered what has settled.
    bool settled = camera.still_frames > uint(SETTLED_ROUNDS * params.bounce_frames + params.turns);
    if (of_few || !settled || camera.view_projection == camera.previous_view_projection) return true;
    uint rarer = uint(params.gather_rest);
    if (params.specular_cone) {
        float turned = distance(seen.to_viewer, normalize(camera.previous_position - seen.position)) * float(params.turns);
        rarer = uint(clamp(ggxAlpha(seen.surface.roughness) / max(turned, 1e-6), 1.0, float(rarer)));
    }
    return (camera.frame + number) % rarer == 0;
}

// Keeps what there is, and says how the pixel must gather, if it must.
bool gathers(ivec2 pixel, uint number, out uint how) {
    GBufferSurface seen = gbufferAt(pixel);
    how = GATHER_ALL;
    if (!seen.any) {
        imageStore(gatheredDiffuse, pixel, vec4(0.0, 0.0, 0.0, 1.0));
        imageStore(gatheredSpecular, pixel, vec4(0.0));
        return false;
    }
    ivec2 at;
    bool kept = seenBefore(seen, at);
    // Whichever pixels a surface moves through, it gathers once in all turns: no light is older, and no ray is wasted.
    float turns = float(params.turns), in_turn = ageInTurn(number), age = in_turn + OF_FEW;
    if (kept) {
        age = ageAt(at);
        if (ages(seen, number, fract(age) != 0.0)) age += 1.0;
    }
    bool due = floor(age) >= turns;
    // Where the picture grows, one pixel's heirs would all be due at once: those a little behind their own turn go back to it.
    if (due) age = in_turn <= 0.25 * turns ? in_turn : 0.0;
    if (!due) how = kept ? GATHER_MIRRORED : GATHER_FEW;
    bool takes = kept && !due;
    if (takes) imageStore(gatheredDiffuse, pixel, texelFetch(lastDiffuse, at, 0));
    imageStore(gatheredSpecular, pixel, vec4(takes ? texelFetch(lastSpecular, at, 0).rgb : vec3(0.0), age));
    return !takes || params.specular_cone && seen.surface.roughness < KEPT_ROUGHNESS;
}

// Sums up how many are of the kinds before each.
void sumUp() {
    uint kind = gl_LocalInvocationIndex, own = starts[kind];
    for (uint apart = 1; apart < KINDS; apart *= 2) {
        uint before = kind >= apart ? starts[kind - apart] : 0;
        barrier();
        starts[kind] += before;
        barrier();
    }
    uint all = starts[kind];
    barrier();
    starts[kind] = all - own;
    if (kind == KINDS - 1 && all > 0) {
        first = atomicAdd(gatherCounter.count, all);
        atomicMax(gatherCounter.groups.x, min((first + all + 31) / 32, 65535u));
    }
}

void main() {
    uint thread = gl_LocalInvocationIndex;
    ivec2 corner = REGION * ivec2(gl_WorkGroupID.xy);
    starts[thread] = 0;
    barrier();
    for (uint i = thread; i < EACH * THREADS; i += THREADS) {
        ivec2 pixel = corner + ivec2(i % REGION.x, i / REGION.x);
        uint number = pixelNumber(uvec2(pixel)), how;
        listed[i] = NOT_LISTED;
        if (any(greaterThanEqual(pixel, ivec2(camera.size))) || !gathers(pixel, number, how)) continue;
        uint kind = how * 64 + number;
        listed[i] = kind | atomicAdd(starts[kind], 1) << 8;
    }
    barrier();
    sumUp();
    barrier();
    for (uint i = thread; i < EACH * THREADS; i += THREADS) {
        uint word = listed[i];
        if (word == NOT_LISTED) continue;
        uvec2 pixel = uvec2(corner) + uvec2(i % REGION.x, i / REGION.x);
        gatherList.pixels[first + starts[word & 255] + (word >> 8)] = pixel.x | pixel.y << 15 | (word >> 6 & 3) << 30;
    }
}
