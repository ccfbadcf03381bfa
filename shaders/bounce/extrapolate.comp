#version 460
#extension GL_GOOGLE_include_directive : require
// Extrapolates gathered light at the end of a short round. A round maps the light g of all sides to
// M g + first, linearly. If all light before the round is multiplied by s, the light after it is
// first + s (g - first). s makes the round neither gain nor lose light, summed over all sides. In a closed
// room of one colour, most of the missing light is thus added after the second round.
#include "params.glsl"
#include "voxels/voxels.glsl"
#include "surfels/surfels.glsl"
#include "bounce/gathered.glsl"
#include "bounce/rounds.glsl"
#include "bounce/sums.glsl"

layout(local_size_x = SUM_THREADS) in;

// s - 1.
vec3 gainOf(BounceSums now, uint round) {
    BounceState last = lastRounds.state;
    if (round < 2) return vec3(0.0);
    // A round keeps at most the reflected fraction, and a few directions gain up to 1 % more. Within a round
    // of N frames, light is reflected up to 2 N / (N + 1) times.
    float frames = float(shortRound());
    vec3 reflectance = clamp(now.reflected / max(now.light, 1e-20) + 0.01, 0.0, 0.999);
    vec3 least = (1.0 - pow(reflectance, vec3(2.0 * frames / (frames + 1.0)))) * last.light;
    vec3 lost = max(last.first - (now.light - last.light), least);
    return mix(vec3(0.0), last.first / max(lost, 1e-20) - 1.0, greaterThan(last.first, vec3(1e-20)));
}

void main() {
    BounceSums sums = BounceSums(vec3(0.0), vec3(0.0), vec3(0.0));
    for (uint i = gl_LocalInvocationIndex; i < SUM_GROUPS; i += SUM_THREADS)
        sums = plus(sums, bouncePartials.list[i]);
    sums = groupSum(sums);
    uint round = bounceRounds.state.frame / shortRound(), count = voxelCounter.count * SIDES;
    vec3 gain = gainOf(sums, round);
    if (gl_GlobalInvocationID.x == 0) {
        bounceRounds.state.first = round < 2 ? sums.light : lastRounds.state.first;
        bounceRounds.state.light = sums.light + gain * sums.bounced;
    }
    for (uint i = gl_GlobalInvocationID.x; i < count; i += SUM_GROUPS * SUM_THREADS) {
        SideLight g = sideLightOf(sideGathered.list[i]);
        if (axisOfSurfel(i / SIDES) < 0 || g.updates != round) continue;
        vec3 light = g.light * (1.0 + gain * (1.0 - g.first));
        g.first *= luminance(g.light) / max(luminance(light), 1e-20);
        g.light = light;
        sideGathered.list[i] = packSideLight(g);
    }
}
