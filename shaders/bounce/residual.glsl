// Residuals of the sides that a group has gathered: stores them and adds them to the sums of the round.
#ifndef BOUNCE_RESIDUAL_GLSL
#define BOUNCE_RESIDUAL_GLSL
#include "bounce/acceleration.glsl"

layout(std430) buffer RoundResiduals { RoundSums rounds[2]; } roundResiduals;
layout(std430) buffer SideChanges { SideChange list[]; } sideChanges;

shared int shared_products[6];
shared uint shared_largest[3];

void addProduct(uint which, uint product, int value) {
    if (value == 0) return;
    uint low = uint(value), old = atomicAdd(roundResiduals.rounds[which].products[product][0], low);
    uint high = (value < 0 ? ~0u : 0u) + uint(old + low < old);
    if (high != 0u) atomicAdd(roundResiduals.rounds[which].products[product][1], high);
}

// light: gathered; start: the side's light at the start of the round. counts: whether the side has gathered
// in the round before. All threads of a group call this together, with has_side for those that gathered one.
void recordResidual(bool has_side, uint index, vec3 light, vec3 start, bool counts) {
    uint thread = gl_LocalInvocationIndex, now = shortRoundNumber() & 1u, before = 1u - now;
    if (thread < 6u) shared_products[thread] = 0;
    if (thread < 3u) shared_largest[thread] = 0u;
    barrier();
    if (has_side) {
        bool is_first = shortRoundNumber() == 0u;
        SideChange last = sideChanges.list[index];
        vec3 residual = light - start, growth = residual - residualOf(last);
        vec3 previous = is_first ? light
            : start + stepFrom(roundResiduals.rounds[before]) * advanceOf(last);
        sideChanges.list[index] = packChange(residual, light - previous);
        for (int c = 0; c < 3; c++) {
            atomicMax(shared_largest[c], floatBitsToUint(abs(residual[c])));
            float unit = uintBitsToFloat(roundResiduals.rounds[before].largest[c]);
            if (is_first || !counts || unit <= 0.0) continue;
            float f = clamp(residual[c] / unit, -LARGEST_TERM, LARGEST_TERM);
            float df = clamp(growth[c] / unit, -LARGEST_TERM, LARGEST_TERM);
            atomicAdd(shared_products[c], int(round(f * df * SUM_UNIT)));
            atomicAdd(shared_products[3 + c], int(round(df * df * SUM_UNIT)));
        }
    }
    barrier();
    if (thread < 6u) addProduct(now, thread, shared_products[thread]);
    if (thread < 3u) atomicMax(roundResiduals.rounds[now].largest[thread], shared_largest[thread]);
}

#endif
