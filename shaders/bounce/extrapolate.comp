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

// Share of the balance, so that no frame is too bright. The next round adds the rest.
const float CAUTION = 0.95;

// Least fraction of the light that a round loses. Few directions gain up to 0.5 % a bounce. Each frame of a
// round reflects the light of the frames before it.
vec3 leastLoss(vec3 reflectance) {
    reflectance = clamp(reflectance + 0.005, 0.0, 0.999);
    uint frames = shortRound();
    vec3 light = vec3(1.0), sum = vec3(0.0);
    for (uint i = 1; i <= frames; i++) {
        sum += float(i) * light;
        light *= 1.0 + reflectance / float(frames);
    }
    return (1.0 - reflectance) * sum * 2.0 / float(frames * (frames + 1));
}

// s - 1.
vec3 gainOf(BounceSums now, uint round) {
    BounceState last = lastRounds.state;
    if (round < 2) return vec3(0.0);
    vec3 least = leastLoss(now.reflected / max(now.light, 1e-20)) * last.light;
    vec3 lost = max(last.first - (now.light - last.light), least);
    vec3 gain = last.first / max(lost, 1e-20) - 1.0;
    gain *= mix(vec3(1.0), vec3(CAUTION), greaterThan(gain, vec3(0.0)));
    return mix(vec3(0.0), gain, greaterThan(last.first, vec3(1e-20)));
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
